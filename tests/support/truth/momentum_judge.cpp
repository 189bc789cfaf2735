// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/truth/momentum_judge.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

namespace marey::testing {
namespace {

struct JudgedFrame {
  std::vector<glm::dvec3> p_in_world;  // Centre of each mass.
  std::vector<glm::dmat3> turn;        // World from the mass's joint.
  glm::dvec3 com_in_world{0.0};
};

JudgedFrame judged_frame(const Skeleton& skeleton,
                         std::span<const PointMass> masses,
                         const Pose& pose) {
  std::vector<glm::dmat4> joints;
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    const Joint& joint = skeleton.joints[j];
    glm::dmat4 local(glm::mat3_cast(pose.parent_from_joint[j]));
    const glm::dvec3& at =
        joint.parent ? joint.parent_from_joint.translation : pose.root_in_world;
    local[3] = glm::dvec4(at, 1.0);
    joints.push_back(joint.parent ? joints[index(*joint.parent)] * local : local);
  }
  JudgedFrame out;
  double total_kg = 0.0;
  for (const PointMass& mass : masses) {
    const glm::dmat4& joint = joints[index(mass.joint)];
    out.p_in_world.emplace_back(joint * glm::dvec4(mass.p_in_joint, 1.0));
    out.turn.emplace_back(joint);
    out.com_in_world += mass.mass_kg * out.p_in_world.back();
    total_kg += mass.mass_kg;
  }
  out.com_in_world /= total_kg;
  return out;
}

// Rotation vector of b relative to a, by the logarithm of the quaternion.
glm::dvec3 turn_between(const glm::dmat3& a, const glm::dmat3& b) {
  glm::dquat q = glm::quat_cast(b * glm::transpose(a));
  if (q.w < 0.0) q = -q;
  const glm::dvec3 v(q.x, q.y, q.z);
  const double s = glm::length(v);
  return s < 1e-12 ? 2.0 * v : (2.0 * std::atan2(s, q.w) / s) * v;
}

}  // namespace

std::vector<glm::dvec3> judged_momentum(const Skeleton& skeleton,
                                        std::span<const PointMass> masses,
                                        double rate_hz,
                                        std::span<const Pose> poses,
                                        Differences differences) {
  std::vector<JudgedFrame> frames;
  for (const Pose& pose : poses) frames.push_back(judged_frame(skeleton, masses, pose));
  const bool five = differences == Differences::kFivePoint;
  const std::size_t margin = five ? 2 : 1;
  const double near = five ? 8.0 / 12.0 : 0.5;
  std::vector<glm::dvec3> out;
  for (std::size_t k = margin; k + margin < frames.size(); ++k) {
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < masses.size(); ++i) {
      const auto step = [&](std::size_t n) {
        return frames[k + n].p_in_world[i] - frames[k - n].p_in_world[i];
      };
      const auto turn = [&](std::size_t n) {
        return turn_between(frames[k - n].turn[i], frames[k + n].turn[i]);
      };
      const glm::dvec3 velocity =
          rate_hz * (near * step(1) - (five ? step(2) / 12.0 : glm::dvec3(0.0)));
      const glm::dvec3 omega =
          rate_hz * (near * turn(1) - (five ? turn(2) / 12.0 : glm::dvec3(0.0)));
      const glm::dmat3& world = frames[k].turn[i];
      // The sum of m (p - c) is zero, so the velocity of c drops out.
      sum += masses[i].mass_kg *
             (glm::cross(frames[k].p_in_world[i] - frames[k].com_in_world, velocity) +
              world * (masses[i].inertia_per_kg_m2 * (glm::transpose(world) * omega)));
    }
    out.push_back(sum);
  }
  return out;
}

double largest_sd(std::span<const glm::dvec3> values) {
  if (values.empty()) return 0.0;
  const auto n = static_cast<double>(values.size());
  glm::dvec3 mean(0.0);
  for (const glm::dvec3& v : values) mean += v / n;
  glm::dvec3 variance(0.0);
  for (const glm::dvec3& v : values) variance += (v - mean) * (v - mean) / n;
  return std::sqrt(std::max({variance.x, variance.y, variance.z}));
}

glm::dvec3 judged_com(const Skeleton& skeleton,
                      std::span<const PointMass> masses,
                      const Pose& pose) {
  return judged_frame(skeleton, masses, pose).com_in_world;
}

glm::dmat3 judged_inertia(const Skeleton& skeleton,
                          std::span<const PointMass> masses,
                          const Pose& pose) {
  const JudgedFrame frame = judged_frame(skeleton, masses, pose);
  glm::dmat3 out(0.0);
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const glm::dvec3 d = frame.p_in_world[i] - frame.com_in_world;
    const glm::dmat3& own = masses[i].inertia_per_kg_m2;
    const glm::dmat3 turned = frame.turn[i] * own * glm::transpose(frame.turn[i]);
    // The inertia of a point, element by element, plus its own (Huygens and Steiner).
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        const double parallel = (r == c ? d.x * d.x + d.y * d.y + d.z * d.z : 0.0);
        out[c][r] += masses[i].mass_kg * (parallel - d[r] * d[c] + turned[c][r]);
      }
    }
  }
  return out;
}

}  // namespace marey::testing
