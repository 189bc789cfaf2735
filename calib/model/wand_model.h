// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: conversion of detections of a wand to a RigModel.

#include <cstddef>
#include <span>
#include <vector>

#include "calib/model/rig_model.h"
#include "calib/model/wand_options.h"
#include "core/board.h"
#include "core/detection.h"

namespace marey::calib {

inline constexpr std::size_t kWand = 0;  ///< The first of the model's targets.

/// Builds a model with the sightings of the wand's tags and of static tags. No pose and
/// no lens is estimated yet: cameras have only the image size. Frames belong to one
/// instant if their times, with `offsets_s` added (per camera, as in SolvedClock), round
/// to the same frame of the slowest camera; without offsets, if they have the same
/// number. From a long recording, evenly spaced sections are used. With offsets, these
/// are a second long, because the motion of the wand is observable only from neighbouring
/// frames.
[[nodiscard]] RigModel static_wand_model(std::span<const CameraDetections> waved,
                                         const Wand& wand,
                                         const WandOptions& options,
                                         std::span<const double> offsets_s);

/// Builds a model from a placed model of static_wand_model(), with a smooth motion of the
/// wand between knots and a clock per camera, like moving_model() for boards. All parts
/// of the motion share one layout of tags.
[[nodiscard]] RigModel moving_wand_model(RigModel placed,
                                         std::span<const CameraDetections> waved,
                                         std::span<const double> offsets_s);

}  // namespace marey::calib
