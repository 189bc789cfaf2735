// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>

#include <glm/vec2.hpp>

#include "app/plan/plan_figures.h"

namespace marey::app {

/// One square of a floor map.
struct MapCell {
  glm::dvec2 at{0.0};           ///< Its middle, x and z of the world. [m]
  std::optional<double> share;  ///< Of the scale, more than 1 like 1; nullopt for none.
  std::string words;            ///< Shown when it is pointed at.
};

/// The floor from above as an SVG figure: squares of `step_m`, and the plan's cameras
/// with what their pictures take in.
[[nodiscard]] std::string floor_map(const PlanReport& report,
                                    std::span<const MapCell> cells,
                                    double step_m,
                                    const std::string& caption);

}  // namespace marey::app
