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

#include "core/base/result.h"
#include "core/constraint.h"

namespace marey::retarget {

/// The first error found, if any.
using OptionalError = std::optional<Error>;

// Larger values are errors, and single precision does not represent their squares
// accurately.
inline constexpr double kMaxLength_m = 1e4;
inline constexpr double kMaxTime_s = 1e9;
/// A constraint with this start time or a later one (three years) is started by a caller
/// (Handle::start()), which may also place it. Its position before that contradicts
/// nothing.
inline constexpr double kCallerStart_s = 1e8;

/// Returns an error about a constraint, which it names.
[[nodiscard]] inline Error constraint_error(const Constraint& constraint,
                                            std::string cause,
                                            std::string next) {
  return bad_input(
      "constraint \"" + constraint.id + "\"", std::move(cause), std::move(next));
}

/// Returns the shortest decimal digits, independent of the locale.
[[nodiscard]] inline std::string digits(double value) {
  char text[32];  // NOLINT: filled by to_chars().
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

/// Returns the error "the WHAT is VALUE" if the value is outside [low, high] or NaN.
[[nodiscard]] inline OptionalError check_number(const Constraint& constraint,
                                                std::string_view what,
                                                double value,
                                                double low,
                                                double high) {
  if (value >= low && value <= high) return std::nullopt;  // False for NaN.
  return constraint_error(constraint,
                          std::string("the ").append(what) + " is " + digits(value),
                          std::isfinite(value)
                              ? "use a value from " + digits(low) + " to " + digits(high)
                              : "correct what computes it: it must be a finite number");
}

/// Returns the error "a coordinate of the WHAT is VALUE" if a coordinate is larger than
/// kMaxLength_m or not finite.
[[nodiscard]] inline OptionalError check_place(const Constraint& constraint,
                                               std::string_view what,
                                               const glm::dvec3& p) {
  for (const double coordinate : {p.x, p.y, p.z}) {
    if (std::abs(coordinate) <= kMaxLength_m) continue;  // False for NaN.
    return constraint_error(
        constraint,
        std::string("a coordinate of the ").append(what) + " is " + digits(coordinate),
        std::isfinite(coordinate)
            ? "give it in metres; the maximum is 10 km"
            : "correct what computes it: it must be a finite number");
  }
  return std::nullopt;
}

}  // namespace marey::retarget
