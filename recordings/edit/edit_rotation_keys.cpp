// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/edit/edit_rotation_keys.h"

#include <array>
#include <charconv>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/degrees.h"
#include "core/base/in_quotes.h"
#include "recordings/body/constraint_words.h"
#include "recordings/edit/edit_limits.h"
#include "recordings/edit/edit_value_keys.h"

namespace marey::recordings::recipe {
namespace {

/// Returns `degrees` with this number of significant digits.
double with_digits(double degrees, int digits) {
  std::array<char, 40> text{};
  const auto [end, problem] = std::to_chars(text.data(),
                                            text.data() + text.size(),
                                            degrees,
                                            std::chars_format::scientific,
                                            digits - 1);
  double rounded = degrees;
  if (problem == std::errc{}) std::from_chars(text.data(), end, rounded);
  return rounded;
}

/// Returns the rotation of axis times angle; w >= 0.
glm::dquat from_vector_deg(const glm::dvec3& vector_deg) {
  const double angle_deg = glm::length(vector_deg);
  if (!(angle_deg > 0.0)) return {1.0, 0.0, 0.0, 0.0};
  const double half_rad = 0.5 * angle_deg * kRadiansPerDegree;
  const glm::dvec3 v = std::sin(half_rad) / angle_deg * vector_deg;
  const glm::dquat q(std::cos(half_rad), v.x, v.y, v.z);
  return q.w < 0.0 ? -q : q;
}

/// Returns axis times angle in degrees; the angle is at most 180 degrees if w >= 0.
glm::dvec3 to_vector_deg(const glm::dquat& q) {
  const glm::dvec3 v(q.x, q.y, q.z);
  const double sine = glm::length(v);
  if (!(sine > 0.0)) return glm::dvec3(0.0);
  return 2.0 * std::atan2(sine, q.w) * kDegreesPerRadian / sine * v;
}

/// Returns the vector with the fewest decimals that gives the same quaternion.
std::optional<glm::dvec3> short_vector_deg(const glm::dquat& q) {
  const glm::dvec3 exact = to_vector_deg(q);
  constexpr int kMaxDecimals = 9;
  double scale = 1.0;
  for (int decimals = 0; decimals <= kMaxDecimals; ++decimals, scale *= 10.0) {
    const glm::dvec3 rounded = glm::round(exact * scale) / scale + 0.0;
    if (from_vector_deg(rounded) == q) return rounded;
  }
  return std::nullopt;
}

}  // namespace

double degrees_to_write(double angle_rad) {
  const double degrees = angle_rad * kDegreesPerRadian;
  constexpr int kMaxDigits = 17;
  for (int digits = 1; digits <= kMaxDigits; ++digits) {
    const double rounded = with_digits(degrees, digits);
    if (rounded * kRadiansPerDegree == angle_rad) return rounded;
  }
  // The products round by 6e-16 at most, half a unit of the 14th digit is 5e-15 or more.
  return with_digits(degrees, 14);
}

std::vector<std::string> rotation_keys(std::string_view key) {
  return {std::string(key).append("_deg"), std::string(key).append("_wxyz")};
}

std::optional<glm::dquat> read_rotation(TomlReader& in, std::string_view key) {
  const std::vector<std::string> keys = rotation_keys(key);
  const std::string& deg = keys[0];
  const std::string& wxyz = keys[1];
  if (in.has(deg) && in.has(wxyz)) fail_twice(in, deg, wxyz);
  if (in.has(deg)) {
    const std::vector<double> v = read_numbers(in, deg, 3, kRotation);
    return from_vector_deg({v[0], v[1], v[2]});
  }
  if (!in.has(wxyz)) return std::nullopt;
  const std::vector<double> v = in.numbers(wxyz, 4);
  const glm::dquat q(v[0], v[1], v[2], v[3]);
  constexpr double kRounded = 1e-3;  // Three digits, the usual rounding by hand.
  if (!(std::abs(glm::length(q) - 1.0) <= kRounded)) {
    in.fail(
        wxyz, in_quotes(wxyz) + " is not a unit quaternion", "divide it by its length");
  }
  return in.ok() ? normalized_once(q) : glm::dquat(1.0, 0.0, 0.0, 0.0);
}

void write_rotation(TomlWriter& out, std::string_view key, const glm::dquat& rotation) {
  const glm::dquat q = normalized_once(rotation);
  const std::vector<std::string> keys = rotation_keys(key);
  if (const auto v = short_vector_deg(q)) {
    out.numbers(keys[0], {v->x, v->y, v->z});
  } else {
    out.numbers(keys[1], {q.w, q.x, q.y, q.z});
  }
}

}  // namespace marey::recordings::recipe
