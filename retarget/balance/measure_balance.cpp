// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/balance/measure_balance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "core/base/assert.h"
#include "core/human/centre_of_mass.h"
#include "core/pose.h"
#include "retarget/body/foot_shape.h"
#include "retarget/body/rotation_from_t_pose.h"
#include "retarget/contacts/frame_marks.h"
#include "retarget/feet/leg_placement.h"

namespace marey::retarget {
namespace {

// Part of the sole that bears when the foot is on its heel.
constexpr double kHeelPart = 0.25;

// Returns the ground projection: X, Z.
glm::dvec2 ground_projection(const glm::dvec3& p) {
  return {p.x, p.z};
}

double cross(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

// Corners of the support area, then their convex hull, counterclockwise.
class Hull {
 public:
  static constexpr std::size_t kMax = 8;  // Two feet with four corners each.

  void add(const glm::dvec2& p) { corners_[count_++] = p; }
  [[nodiscard]] bool empty() const { return count_ == 0; }
  // Precondition: closed.
  [[nodiscard]] std::span<const glm::dvec2> corners() const {
    return {hull_.data(), size_};
  }

  // Computes the hull by Andrew's monotone chain.
  void close() {
    const auto first = corners_.begin();
    const auto end = first + static_cast<std::ptrdiff_t>(count_);
    std::sort(first, end, [](const glm::dvec2& a, const glm::dvec2& b) {
      return a.x != b.x ? a.x < b.x : a.y < b.y;
    });
    count_ = static_cast<std::size_t>(std::unique(first, end) - first);
    if (count_ == 1) {
      hull_[size_++] = corners_[0];
      return;
    }
    const auto chain = [&](std::size_t base, const glm::dvec2& p) {
      while (size_ >= base + 2 &&
             cross(hull_[size_ - 1] - hull_[size_ - 2], p - hull_[size_ - 1]) <= 0.0) {
        --size_;
      }
      hull_[size_++] = p;
    };
    for (std::size_t i = 0; i < count_; ++i) chain(0, corners_[i]);
    const std::size_t base = size_ - 1;
    for (std::size_t i = count_ - 1; i-- > 0;) chain(base, corners_[i]);
    --size_;  // The last corner equals the first.
  }

  // Returns the distance outside; negative inside. Points and lines have no inside.
  [[nodiscard]] double outside_m(const glm::dvec2& p) const {
    double nearest = std::numeric_limits<double>::max();
    bool within = size_ > 2;
    for (std::size_t i = 0; i < size_; ++i) {
      const glm::dvec2 a = hull_[i];
      const glm::dvec2 along = hull_[(i + 1) % size_] - a;
      within &= cross(along, p - a) >= 0.0;
      const double squared = glm::dot(along, along);
      const double at =
          squared > 0.0 ? std::clamp(glm::dot(p - a, along) / squared, 0.0, 1.0) : 0.0;
      nearest = std::min(nearest, glm::length(p - a - at * along));
    }
    return within ? -nearest : nearest;
  }

 private:
  std::array<glm::dvec2, kMax> corners_{};
  std::size_t count_ = 0;
  std::array<glm::dvec2, 2 * kMax> hull_{};
  std::size_t size_ = 0;
};

// Ends of one sole in ground projection.
struct Sole {
  glm::dvec2 heel{0.0};
  glm::dvec2 ball{0.0};
  glm::dvec2 tip{0.0};
};

Sole sole_of(const BodyMap& map,
             std::span<const RigidTransform> world_from_joint,
             int side) {
  const FootMap& foot = map.feet[static_cast<std::size_t>(side)];
  const JointIndex ankle = map.leg(side).end;
  const glm::dquat turn = rotation_from_t_pose(map, world_from_joint, ankle);
  const glm::dvec3 at = world_from_joint[index(ankle)].translation;
  const glm::dvec3 ball = at + turn * foot.ball_from_ankle_in_t_pose;
  const auto toes = map.joint_of[index(toes_bone(side))];
  const glm::dquat toes_turn =
      toes ? rotation_from_t_pose(map, world_from_joint, *toes) : turn;
  return {ground_projection(at + turn * foot.heel_from_ankle_in_t_pose),
          ground_projection(ball),
          ground_projection(ball + toes_turn * foot.tip_from_ball_in_t_pose)};
}

void add_foot(const Sole& sole, bool heel_bears, bool ball_bears, Hull& hull) {
  const glm::dvec2 ahead = sole.tip - sole.heel;
  const glm::dvec2 aside =
      // The vector has this length.
      0.5 * kBreadthInFoot * glm::dvec2(-ahead.y, ahead.x);
  const glm::dvec2 from = heel_bears ? sole.heel : sole.ball;
  const glm::dvec2 to = ball_bears ? sole.tip : sole.heel + kHeelPart * ahead;
  for (const glm::dvec2& p : {from, to}) {
    hull.add(p - aside);
    hull.add(p + aside);
  }
}

// Returns the support area of one posture: closed, unless it is empty.
Hull hull_of(const BodyMap& map,
             std::span<const RigidTransform> world_from_joint,
             const std::array<StandingFoot, 2>& standing) {
  Hull hull;
  for (std::size_t side = 0; side < 2; ++side) {
    const StandingFoot& stands = standing[side];
    if (!stands.heel && !stands.ball) continue;
    const Sole sole = sole_of(map, world_from_joint, static_cast<int>(side));
    add_foot(sole, stands.heel, stands.ball, hull);
  }
  if (!hull.empty()) hull.close();
  return hull;
}

// Calls `each(frame, centre of mass in the world, support area)`. The hull is closed
// unless there is no support.
template <class Each>
void for_each_frame(const Motion& motion,
                    const BodyMap& map,
                    std::span<const PointMass> masses,
                    const Contacts& contacts,
                    const Each& each) {
  MAREY_ASSERT(contacts.frame_count == static_cast<int>(motion.poses.size()));
  std::array<std::vector<char>, 2> heel;
  std::array<std::vector<char>, 2> ball;
  for (std::size_t side = 0; side < 2; ++side) {
    heel[side] = frame_marks(contacts.feet[side].heel, motion.poses.size());
    ball[side] = frame_marks(contacts.feet[side].ball, motion.poses.size());
  }
  std::vector<RigidTransform> world_from_joint(motion.skeleton.joints.size());
  for (std::size_t t = 0; t < motion.poses.size(); ++t) {
    world_from_joints(motion.skeleton, motion.poses[t], world_from_joint);
    std::array<StandingFoot, 2> standing;
    for (std::size_t side = 0; side < 2; ++side) {
      standing[side] = {heel[side][t] != 0, ball[side][t] != 0};
    }
    each(t,
         centre_of_mass(masses, world_from_joint),
         hull_of(map, world_from_joint, standing));
  }
}

}  // namespace

void balance_of_posture(const BodyMap& map,
                        std::span<const PointMass> masses,
                        std::span<const RigidTransform> world_from_joint,
                        const std::array<StandingFoot, 2>& standing,
                        BalanceFrame& out) {
  const Hull hull = hull_of(map, world_from_joint, standing);
  const auto corners = hull.corners();
  out.centre_of_mass_in_world = centre_of_mass(masses, world_from_joint);
  out.support_xz_m.reserve(Hull::kMax);
  out.support_xz_m.assign(corners.begin(), corners.end());
  out.zmp_xz_m.reset();
}

BalanceTrack track_balance(const Motion& motion,
                           const BodyMap& map,
                           std::span<const PointMass> masses,
                           const Contacts& contacts) {
  BalanceTrack out(motion.poses.size());
  for_each_frame(motion,
                 map,
                 masses,
                 contacts,
                 [&](std::size_t t, const glm::dvec3& centre, const Hull& hull) {
                   if (!hull.empty()) out[t] = hull.outside_m(ground_projection(centre));
                 });
  return out;
}

std::vector<BalanceFrame> balance_frames(const Motion& motion,
                                         const BodyMap& map,
                                         std::span<const PointMass> masses,
                                         const Contacts& contacts) {
  std::vector<BalanceFrame> out(motion.poses.size());
  for_each_frame(motion,
                 map,
                 masses,
                 contacts,
                 [&](std::size_t t, const glm::dvec3& centre, const Hull& hull) {
                   const auto corners = hull.corners();
                   out[t] = {centre, {corners.begin(), corners.end()}, {}};
                 });
  return out;
}

BalanceFigures balance_measures(const BalanceTrack& track, const BalanceTrack& source) {
  MAREY_ASSERT(source.empty() || source.size() == track.size());
  BalanceFigures out;
  for (std::size_t t = 0; t < track.size(); ++t) {
    if (!track[t]) continue;
    ++out.supported_frames;
    const bool is_over = *track[t] <= 0.0;
    if (is_over) ++out.over_frames;
    const bool was_over = !source.empty() && source[t] && *source[t] <= 0.0;
    if (was_over && !is_over) ++out.lost_frames;
  }
  return out;
}

}  // namespace marey::retarget
