// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "app/calibration_report.h"

namespace marey::app {

/// What each camera's sightings say. `report` has its rig, extent and clocks.
[[nodiscard]] std::vector<CameraMeasures> measure_cameras(
    const CalibrationReport& report);

/// Where points will stand, and how well. With a floor the map takes in a square of 4 m
/// around where the cameras look, and wherever the board was; its heights are those of
/// ankle, hip and shoulder. Without one it takes in where the board was, at the heights
/// of the tenth, middle and ninetieth of a hundred of its places.
[[nodiscard]] CalibrationMap map_errors(const CalibrationReport& report);

}  // namespace marey::app
