// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: what cameras saw of a wand as a RigModel.

#include <cstddef>
#include <span>
#include <vector>

#include "calib/calibrate_wand.h"
#include "calib/rig_model.h"
#include "core/board.h"
#include "core/detection.h"

namespace marey::calib {

inline constexpr std::size_t kWand = 0;  ///< The first of the model's targets.

/// Sightings of the wand's tags, and of the scenery's, nothing placed yet and no lens
/// known: cameras have the picture's size alone. Frames belong to one instant when their
/// times, `offsets_s` added (per camera, as SolvedClock's), round to the same frame of
/// the slowest camera; without offsets when they have one number. Of a long recording,
/// stretches chosen evenly: with offsets of a second each, since only neighbours tell how
/// the wand moves.
[[nodiscard]] RigModel wand_at_instants(std::span<const CameraDetections> waved,
                                        const Wand& wand,
                                        const WandOptions& options,
                                        std::span<const double> offsets_s);

/// A model of wand_at_instants() whose wand has been placed, with the wand moving
/// smoothly between knots and every camera on its own clock, as moving_model() has
/// boards. The tags sit alike on it in each part of the motion.
[[nodiscard]] RigModel wand_in_motion(RigModel placed,
                                      std::span<const CameraDetections> waved,
                                      std::span<const double> offsets_s);

}  // namespace marey::calib
