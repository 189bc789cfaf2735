// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <glm/vec2.hpp>

#include "app/plan_figures.h"

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

/// The colour of that share of a scale, as the report's page has it: 0 is dark blue.
[[nodiscard]] std::string colour(double share);

/// `text` where HTML wants words, in an element or an attribute.
[[nodiscard]] std::string escaped(std::string_view text);

/// snprintf() of up to three numbers. Precondition: fewer than 400 characters.
[[nodiscard]] std::string text_of(const char* format,
                                  double a,
                                  double b = 0.0,
                                  double c = 0.0);

}  // namespace marey::app
