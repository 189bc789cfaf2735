// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tests/support/truth/body_judge.h"

namespace marey::testing {

/// Computes BodyFigures::foot_yaw_deg, foot_yaw_bone and foot_yaw_frame. Precondition:
/// `heading_deg` of `out` is set; both have the same number of frames, at `hz`.
void compare_feet(const std::vector<Landmarks>& source,
                  const std::vector<Landmarks>& body,
                  double hz,
                  BodyFigures& out);

}  // namespace marey::testing
