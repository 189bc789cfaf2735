// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <glm/vec3.hpp>

#include "core/constraint.h"
#include "core/result.h"

namespace marey::retarget {

/// What is wrong, if anything.
using Refusal = std::optional<Error>;

// Beyond these lie mistakes, and squares that single precision does not hold.
inline constexpr double kFurthest_m = 1e4;
inline constexpr double kLatest_s = 1e9;
/// What starts so late (three years) starts when a caller says so (Handle::start()), who
/// may place it, too: where it is until then contradicts nothing.
inline constexpr double kUntilTold_s = 1e8;

[[nodiscard]] inline Error refused(const Constraint& constraint,
                                   std::string cause,
                                   std::string next) {
  return bad_input(
      "constraint \"" + constraint.id + "\"", std::move(cause), std::move(next));
}

/// The shortest digits, whatever the locale.
[[nodiscard]] inline std::string digits(double value) {
  char text[32];  // NOLINT: filled by to_chars().
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

/// "the WHAT is VALUE", when it is outside [low, high] or not a number.
[[nodiscard]] inline Refusal check_number(const Constraint& constraint,
                                          std::string_view what,
                                          double value,
                                          double low,
                                          double high) {
  if (value >= low && value <= high) return std::nullopt;  // False of NaN.
  return refused(constraint,
                 std::string("the ").append(what) + " is " + digits(value),
                 std::isfinite(value)
                     ? "give one from " + digits(low) + " to " + digits(high)
                     : "correct what computes it: it must be a finite number");
}

[[nodiscard]] inline Refusal check_place(const Constraint& constraint,
                                         std::string_view what,
                                         const glm::dvec3& p) {
  for (const double coordinate : {p.x, p.y, p.z}) {
    if (std::abs(coordinate) <= kFurthest_m) continue;  // False of NaN.
    return refused(
        constraint,
        std::string("a coordinate of the ").append(what) + " is " + digits(coordinate),
        std::isfinite(coordinate)
            ? "give it in metres; 10 km is the furthest"
            : "correct what computes it: it must be a finite number");
  }
  return std::nullopt;
}

}  // namespace marey::retarget
