// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/model/target_velocity.h"

#include <iterator>

#include "calib/model/project_point.h"

namespace marey::calib {
namespace {

// Over a longer time, the speed of a hand changes.
constexpr double kMaxGap_s = 0.25;
constexpr double kMaxTargetSpeed_m_s = 5.0;
constexpr double kMaxTargetTurn_rad_s = 12.0;

}  // namespace

std::optional<Velocity> velocity_at(const RigidTarget& target,
                                    int instant,
                                    double rate_hz) {
  const auto at = target.world_from_target.find(instant);
  if (at == target.world_from_target.end() || at == target.world_from_target.begin()) {
    return std::nullopt;
  }
  const auto before = std::prev(at);
  const auto after = std::next(at);
  if (after == target.world_from_target.end()) return std::nullopt;
  const double before_s = (instant - before->first) / rate_hz;
  const double after_s = (after->first - instant) / rate_hz;
  if (before_s > kMaxGap_s || after_s > kMaxGap_s) return std::nullopt;
  const RigidTransform& a = before->second;
  const RigidTransform& b = after->second;
  const double run_s = before_s + after_s;
  const Velocity v{
      to_eigen(rotation_vector(b.rotation * glm::conjugate(a.rotation))) / run_s,
      to_eigen(b.translation - a.translation) / run_s};
  if (v.move_m_s.norm() > kMaxTargetSpeed_m_s ||
      v.turn_rad_s.norm() > kMaxTargetTurn_rad_s) {
    return std::nullopt;
  }
  return v;
}

}  // namespace marey::calib
