// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/parts/compare_angles.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <glm/gtc/quaternion.hpp>

namespace marey {

using recordings::MotTable;

namespace {

/// Interpolates a column between two rows. Returns nullopt before the first row, after
/// the last row, and for missing numbers.
std::optional<double> at_time(const MotTable& table, std::size_t column, double time_s) {
  // Files store times with few digits: a row within a tenth of a millisecond matches.
  constexpr double kNearS = 1e-4;
  const auto& times = table.time_s;
  if (times.empty() || time_s < times.front() - kNearS ||
      time_s > times.back() + kNearS) {
    return std::nullopt;
  }
  const auto after = std::lower_bound(times.begin(), times.end(), time_s);
  const auto row = static_cast<std::size_t>(after - times.begin());
  if (row == 0) return table.at(0, column);
  if (row == times.size()) return table.at(row - 1, column);
  const double step_s = times[row] - times[row - 1];
  const double share = step_s > 0.0 ? (time_s - times[row - 1]) / step_s : 0.0;
  const double before = table.at(row - 1, column);
  const double value = before + share * (table.at(row, column) - before);
  return std::isnan(value) ? std::nullopt : std::optional(value);
}

}  // namespace

Difference compare_columns(const MotTable& mine,
                           std::size_t column,
                           const MotTable& theirs,
                           std::size_t their_column,
                           double shift_s) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  std::vector<double> off;
  for (std::size_t row = 0; row < theirs.rows(); ++row) {
    const double their = theirs.at(row, their_column);
    const auto my = at_time(mine, column, theirs.time_s[row] - shift_s);
    if (!my || std::isnan(their)) continue;
    double difference = *my - their;
    if (mine.columns[column].is_angle) {
      const double near = off.empty() ? 0.0 : off.back();
      difference = near + std::remainder(difference - near, kTurn);
    }
    off.push_back(difference);
  }
  Difference out;
  out.rows = off.size();
  if (off.empty()) return out;
  for (const double d : off) out.offset += d / static_cast<double>(off.size());
  for (const double d : off) {
    out.rms += (d - out.offset) * (d - out.offset) / static_cast<double>(off.size());
    out.worst = std::max(out.worst, std::abs(d - out.offset));
  }
  out.rms = std::sqrt(out.rms);
  return out;
}

std::vector<AngleTriple> angle_triples() {
  std::vector<AngleTriple> out{
      {{"pelvis_tilt", "pelvis_list", "pelvis_rotation"}},
      {{"lumbar_extension", "lumbar_bending", "lumbar_rotation"}},
  };
  for (const std::string side : {"_r", "_l"}) {
    out.push_back(
        {{"hip_flexion" + side, "hip_adduction" + side, "hip_rotation" + side}});
    out.push_back({{"arm_flex" + side, "arm_add" + side, "arm_rot" + side}});
  }
  return out;
}

namespace {

/// Computes the joint's rotation at a time. For a left joint it is the rotation of the
/// mirror image, which has the same angle.
std::optional<glm::dquat> rotation_at(const MotTable& table,
                                      const AngleTriple& triple,
                                      double time_s) {
  constexpr std::array<int, 3> kAxes{2, 0, 1};
  glm::dquat rotation(1.0, 0.0, 0.0, 0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto column = table.find(triple.columns[i]);
    const auto angle = column ? at_time(table, *column, time_s) : std::nullopt;
    if (!angle) return std::nullopt;
    glm::dvec3 axis(0.0);
    axis[kAxes[i]] = 1.0;
    rotation = rotation * glm::angleAxis(*angle, axis);
  }
  return rotation;
}

double angle_of(const glm::dquat& q) {
  return 2.0 * std::atan2(std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z), std::abs(q.w));
}

}  // namespace

Difference compare_rotations(const MotTable& mine,
                             const MotTable& theirs,
                             const AngleTriple& triple,
                             double shift_s) {
  std::vector<glm::dquat> off;
  glm::dquat sum(0.0, 0.0, 0.0, 0.0);
  for (const double time_s : theirs.time_s) {
    const auto my = rotation_at(mine, triple, time_s - shift_s);
    const auto their = rotation_at(theirs, triple, time_s);
    if (!my || !their) continue;
    glm::dquat difference = glm::conjugate(*their) * *my;
    if (glm::dot(difference, sum) < 0.0) difference = -difference;
    sum = sum + difference;
    off.push_back(difference);
  }
  Difference out;
  out.rows = off.size();
  if (off.empty()) return out;
  const glm::dquat mean = glm::normalize(sum);
  out.offset = angle_of(mean);
  for (const glm::dquat& d : off) {
    const double left = angle_of(glm::conjugate(mean) * d);
    out.rms += left * left / static_cast<double>(off.size());
    out.worst = std::max(out.worst, left);
  }
  out.rms = std::sqrt(out.rms);
  return out;
}

bool negate_columns(MotTable& table, const std::string& name) {
  bool found = false;
  for (const char* side : {"", "_r", "_l"}) {
    const auto column = table.find(name + side);
    if (!column) continue;
    found = true;
    for (std::size_t row = 0; row < table.rows(); ++row) table.at(row, *column) *= -1.0;
  }
  return found;
}

}  // namespace marey
