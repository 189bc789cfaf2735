// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>

#include <glm/vec2.hpp>

#include "app/plan/plan_json.h"

namespace marey::app {

/// One square of a floor map.
struct MapCell {
  glm::dvec2 at{0.0};           ///< Centre, x and z in the world. [m]
  std::optional<double> share;  ///< Share of the scale, clamped to 1; nullopt: none.
  std::string words;            ///< Tooltip.
};

/// Returns the floor from above as an SVG figure: squares of `step_m`, and the cameras of
/// the plan with their fields of view.
[[nodiscard]] std::string floor_map(const PlanReport& report,
                                    std::span<const MapCell> cells,
                                    double step_m,
                                    const std::string& caption);

}  // namespace marey::app
