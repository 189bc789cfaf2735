// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "retarget/feet/foot_place.h"

namespace marey::edit {

/// Returns the places of a foot between frames: cubics that do not overshoot, so a foot
/// that stands keeps its place exactly, to the last frame of its stance. (Splines swing
/// there by millimetres.) The slope at a frame is the harmonic mean of the slopes on both
/// sides, 0 where they differ in sign (Fritsch & Butland 1984), per coordinate. Whole
/// numbers give the place of the frame to the bit. Linear in frames.
/// Precondition: `places` is not empty; `at_frame` within its frames.
[[nodiscard]] std::vector<retarget::FootPlace> foot_course(
    std::span<const retarget::FootPlace> places, std::span<const double> at_frame);

}  // namespace marey::edit
