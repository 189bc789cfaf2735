// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/step/landing.h"

#include <algorithm>
#include <cmath>

#include "engine/clips/sample_clip.h"
#include <glm/geometric.hpp>

namespace marey::engine {
namespace {

// Interval of the search, in which a contact must last to be seen, and precision of the
// time that is found.
constexpr double kSearch_s = 0.01;
constexpr int kHalvings = 6;
// Interval of the difference that is the velocity.
constexpr double kBack_s = 0.004;
// The other foot bears, too, if it still does after this time.
constexpr double kTogether_s = 0.05;
// A foot lands at most this far from its place in the blend.
constexpr double kFarthest_legs = 0.15;

bool bears_at(const BlendPlayer& blend, std::size_t side, double time_s) {
  const PerFootPart bears = blend.predict_bears(time_s);
  return std::max(bears[2 * side], bears[2 * side + 1]) > kBearsAbove;
}

std::optional<double> landing_time_s(const BlendPlayer& blend,
                                     std::size_t side,
                                     double time_s,
                                     double within_s) {
  if (bears_at(blend, side, time_s)) return std::nullopt;
  double before_s = time_s;
  while (before_s < time_s + within_s) {
    double after_s = std::min(before_s + kSearch_s, time_s + within_s);
    if (!bears_at(blend, side, after_s)) {
      before_s = after_s;
      continue;
    }
    for (int i = 0; i < kHalvings; ++i) {
      const double middle_s = 0.5 * (before_s + after_s);
      (bears_at(blend, side, middle_s) ? after_s : before_s) = middle_s;
    }
    return after_s;
  }
  return std::nullopt;
}

// A rotation in the world, of a rotation in the heading frame of a place.
glm::dquat in_world(const RootPlace& root, const glm::dquat& rotation) {
  return glm::angleAxis(root.heading_rad, glm::dvec3(0.0, 1.0, 0.0)) * rotation;
}

glm::dvec3 in_world(const RootPlace& root, const glm::dvec3& v) {
  const double c = std::cos(root.heading_rad);
  const double s = std::sin(root.heading_rad);
  return {c * v.x + s * v.z, v.y, c * v.z - s * v.x};
}

glm::dquat foot_rotation(const BlendPosture& posture, std::size_t side) {
  static_assert(kPostureSegments[7] == HumanBone::kLeftFoot);
  const std::size_t i = kSegmentRotation + 7 + side;
  return glm::normalize(glm::dquat(static_cast<double>(posture.w[i]),
                                   static_cast<double>(posture.x[i]),
                                   static_cast<double>(posture.y[i]),
                                   static_cast<double>(posture.z[i])));
}

glm::dvec3 small_turn(const glm::dquat& from, const glm::dquat& to) {
  glm::dquat q = to * glm::conjugate(from);
  if (q.w < 0.0) q = -q;
  const double angle = 2.0 * std::acos(std::min(q.w, 1.0));
  const glm::dvec3 v(q.x, q.y, q.z);
  const double sine = glm::length(v);
  return sine < 1e-9 ? 2.0 * v : v * (angle / sine);
}

// The action that bears on a foot with the greatest weight at a time; nullptr: none.
const Action* bearer(const BlendPlayer& blend, std::size_t side, double time_s) {
  const Action* best = nullptr;
  double most = 0.0;
  for (const Action& action : blend.actions()) {
    if (!action.is_alive() || action.is_live || action.leg_priority() <= 0.0F) continue;
    const MotionClip& clip = blend.base().clip(action.clip);
    if ((bearing_at(clip, action.warp.source_s(time_s)) >> (2 * side) & 3U) == 0U)
      continue;
    const double weight =
        static_cast<double>(action.leg_priority()) * action.fade(time_s);
    if (weight <= most) continue;
    most = weight;
    best = &action;
  }
  return best;
}

}  // namespace

std::optional<FootReference::Landing> next_landing(const BlendPlayer& blend,
                                                   std::size_t side,
                                                   double time_s,
                                                   double within_s) {
  const auto at_s = landing_time_s(blend, side, time_s, within_s);
  if (!at_s) return std::nullopt;
  const Rig& rig = blend.rig();
  const RootPlace start = blend.root();
  BlendPosture before;
  BlendPosture posture;
  RootPlace root;
  // The root is taken to be kBack_s before the landing where it is now.
  if (!blend.predict(*at_s - 2.0 * kBack_s, *at_s - kBack_s, before, root)) {
    return std::nullopt;
  }
  (void)blend.predict(*at_s - kBack_s, *at_s, posture, root);
  const FootPlaces feet = foot_places(rig, posture);
  const FootPlaces feet_before = foot_places(rig, before);
  const std::size_t other = 1 - side;
  if (blend.anchors_at(*at_s)) {
    // The other foot stands until then, and the root moves over it.
    const PerFootPart bears = blend.predict_bears(*at_s - kBack_s);
    const bool on_heel = bears[2 * other] > kBearsAbove;
    if (on_heel || bears[2 * other + 1] > kBearsAbove) {
      const auto stood = [&](const RootPlace& place, const FootPlaces& of) {
        const glm::dvec3& p_legs = on_heel ? of.ankle[other] : of.ball[other];
        return glm::dvec3(place.x_m, 0.0, place.z_m) +
               in_world(place, rig.leg_length_m * p_legs);
      };
      const glm::dvec3 slid = stood(start, feet_before) - stood(root, feet);
      root.x_m += slid.x;
      root.z_m += slid.z;
    }
  }
  const auto ankle_at =
      [&](const RootPlace& place, const BlendPosture& of, const FootPlaces& places) {
        glm::dvec3 p = rig.leg_length_m * places.ankle[side];
        p.y += rig.leg_length_m * static_cast<double>(of.height_legs);
        return glm::dvec3(place.x_m, 0.0, place.z_m) + in_world(place, p);
      };
  FootReference::Landing landing;
  landing.in_s = *at_s - time_s;
  landing.ankle_in_world = ankle_at(root, posture, feet);
  landing.velocity_m_s =
      (landing.ankle_in_world - ankle_at(start, before, feet_before)) / kBack_s;
  const PerFootPart bears = blend.predict_bears(*at_s);
  landing.is_flat = std::min(bears[2 * side], bears[2 * side + 1]) > kBearsAbove;
  const glm::dquat rotation = in_world(root, foot_rotation(posture, side));
  landing.spin_rad_s =
      small_turn(in_world(start, foot_rotation(before, side)), rotation) / kBack_s;
  const Action* by = bearer(blend, side, *at_s);
  if (by == nullptr || by->phase != ActionPhase::kFadingIn) return landing;
  sample_clip(blend.base().clip(by->clip), by->warp.source_s(*at_s), before);
  landing.turn_rad = small_turn(rotation, in_world(root, foot_rotation(before, side)));
  if (!bears_at(blend, other, *at_s + kTogether_s)) return landing;
  const FootPlaces stands = foot_places(rig, before);
  const glm::dvec3 apart_legs =
      (stands.ankle[side] - stands.ankle[other]) - (feet.ankle[side] - feet.ankle[other]);
  glm::dvec3 shift_legs = in_world(root, apart_legs);
  shift_legs.y = 0.0;
  // Approaches kFarthest_legs.
  shift_legs /= 1.0 + glm::length(shift_legs) / kFarthest_legs;
  landing.shift_in_world = rig.leg_length_m * shift_legs;
  return landing;
}

}  // namespace marey::engine
