// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Selects the vector instructions of a crowd by the processor.

#include <memory>

namespace marey::retarget {

class LaneKernel;
struct Plan;

/// Number of bodies that are adapted in parallel in the vector registers of the
/// processor.
enum class LaneWidth { kOne = 1, kFour = 4, kEight = 8, kSixteen = 16 };

/// Returns true if this processor supports the width; false for values outside the enum.
[[nodiscard]] bool has_lanes(LaneWidth width);

/// Returns the largest width that this processor supports.
[[nodiscard]] LaneWidth max_lanes();

/// Creates the kernel of a width. Precondition: has_lanes(width). Not for use outside
/// this library.
[[nodiscard]] std::unique_ptr<LaneKernel> make_lane_kernel(LaneWidth width,
                                                           const Plan& plan);

}  // namespace marey::retarget
