// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/momentum/ballistic.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/human/centre_of_mass.h"
#include "core/transform.h"

namespace marey::dynamics {

std::optional<FrameRange> flight_frames(double takeoff_s,
                                        double touchdown_s,
                                        FrameRate rate,
                                        std::size_t pose_count) {
  MAREY_ASSERT(rate.hz > 0.0);
  // An instant this near to a frame is that frame's.
  constexpr double kSameFrame = 1e-6;
  const double first = std::floor(takeoff_s * rate.hz + kSameFrame);
  const double last = std::ceil(touchdown_s * rate.hz - kSameFrame);
  const double end = static_cast<double>(pose_count) - 1.0;
  if (!(takeoff_s < touchdown_s) || !(first >= 0.0) || !(last <= end)) {
    return std::nullopt;
  }
  return FrameRange{static_cast<int>(first), static_cast<int>(last)};
}

BallisticReport make_ballistic(const Skeleton& skeleton,
                               std::span<const PointMass> masses,
                               FrameRate rate,
                               std::span<Pose> poses,
                               const BallisticOptions& options) {
  MAREY_ASSERT(rate.hz > 0.0 && std::isfinite(options.gravity_m_s2));
  BallisticReport out;
  if (poses.size() < 3) return out;
  std::vector<RigidTransform> joints(skeleton.joints.size());
  const auto com = [&](const Pose& pose) {
    world_from_joints(skeleton, pose, joints);
    return centre_of_mass(masses, joints);
  };
  const double whole_s = static_cast<double>(poses.size() - 1) / rate.hz;
  const glm::dvec3 fall(0.0, -options.gravity_m_s2, 0.0);
  const BallisticEnds ends =
      options.ends.value_or(BallisticEnds{com(poses.front()), com(poses.back())});
  const glm::dvec3& from = ends.first_in_world;
  const glm::dvec3& to = ends.last_in_world;
  out.first_velocity_m_s = (to - from) / whole_s - 0.5 * whole_s * fall;
  out.last_velocity_m_s = out.first_velocity_m_s + whole_s * fall;
  double squares = 0.0;
  const std::size_t first = options.ends ? 0 : 1;
  for (std::size_t k = first; k + first < poses.size(); ++k) {
    const double t = static_cast<double>(k) / rate.hz;
    const glm::dvec3 wanted = from + t * out.first_velocity_m_s + 0.5 * t * t * fall;
    const glm::dvec3 moved = wanted - com(poses[k]);
    poses[k].root_in_world += moved;
    squares += glm::dot(moved, moved);
    out.moved_max_m = std::max(out.moved_max_m, glm::length(moved));
  }
  out.moved_rms_m = std::sqrt(squares / static_cast<double>(poses.size()));
  out.applied = true;
  if (options.keep_momentum) {
    out.momentum = keep_angular_momentum(skeleton, masses, rate, poses, options.momentum);
  }
  return out;
}

}  // namespace marey::dynamics
