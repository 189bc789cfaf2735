// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "core/motion.h"

namespace marey::testing {

/// The true motion of a rendered recording, from its truth/segments.csv at 30 Hz, or its
/// truth/segments_120hz.csv at the rate of its times (Z up there, Y up here). Its
/// skeleton rests with the thighs apart and every joint's axes parallel to the world's.
/// Bone lengths are means over the recording: a few joints of the truth's spine are not
/// fixed in their parent, the limbs' are. nullopt when the file is not there.
[[nodiscard]] std::optional<Motion> truth_motion(const std::string& segments_csv);

}  // namespace marey::testing
