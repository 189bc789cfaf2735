// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/hands/keep_touches.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/base/frame_range.h"
#include "core/transform.h"
#include "retarget/base/triweight.h"
#include "retarget/constraints/activation.h"
#include "retarget/hands/arm_clearance.h"

namespace marey::retarget {
namespace {

using P = VolumePart;

// Minimum freedom: where neither hand is free, the error is shared equally instead of by
// rounding errors.
constexpr double kMinFreedom = 1e-3;
// Each pass solves, low-passes the difference and adds it, which restores what the
// low-pass removed.
constexpr int kPlacePasses = 3;
constexpr int kDistancePasses = 6;

std::size_t s(int side) {
  return static_cast<std::size_t>(side);
}

RigidTransform world_from(const Capsule& capsule,
                          std::span<const RigidTransform> world_from_joint) {
  return world_from_joint[index(capsule.joint)] * capsule.joint_from_capsule;
}

// Returns the side of the arm that contains the part; nullopt for all other parts.
std::optional<int> arm_side(P part) {
  if (part >= P::kLeftUpperArm && part <= P::kLeftHand) return 0;
  if (part >= P::kRightUpperArm && part <= P::kRightHand) return 1;
  return std::nullopt;
}

bool is_hand(P part) {
  return part == P::kLeftHand || part == P::kRightHand;
}

// Returns the frame of a joint after its bone moved between two pairs of positions.
RigidTransform moved(const RigidTransform& world_from_joint,
                     const glm::dvec3& start,
                     const glm::dvec3& end,
                     const glm::dvec3& new_start,
                     const glm::dvec3& new_end) {
  const glm::dquat turn = rotation_between(end - start, new_end - new_start);
  return {turn * world_from_joint.rotation, new_start};
}

struct Scene {
  const VolumeInMotion& source;
  const VolumeInMotion& avatar;
  const Arms& arms;
};

RigidTransform shifted_part(const VolumeInMotion& body,
                            const Arms& arms,
                            P part,
                            const ArmShifts& shifts,
                            std::size_t t) {
  const Capsule& capsule = *body.volume[part];
  const auto joints = body.frames[t];
  const auto side = arm_side(part);
  const RigidTransform& now = joints[index(capsule.joint)];
  if (!side || !arms.has(*side)) return now * capsule.joint_from_capsule;
  const ArmPlaces from = arms.places(t, *side);
  const ArmPlaces to = arms.places(t, *side, shifts[s(*side)][t]);
  RigidTransform then = now;
  if (is_hand(part)) {
    then.translation += to.wrist - from.wrist;
  } else if (part == on_side(P::kLeftForearm, *side)) {
    then = moved(now, from.elbow, from.wrist, to.elbow, to.wrist);
  } else {
    then = moved(now, from.shoulder, from.elbow, to.shoulder, to.elbow);
  }
  return then * capsule.joint_from_capsule;
}

// Returns the vector from the hand to its target for the touch, shifts included. World,
// [m].
glm::dvec3 touch_error(const Scene& scene,
                       const Touch& touch,
                       const ArmShifts& shifts,
                       std::size_t t) {
  const P hand = on_side(P::kLeftHand, touch.side);
  const auto source_joints = scene.source.frames[t];
  const Capsule& source_hand = *scene.source.volume[hand];
  const Capsule& source_part = *scene.source.volume[touch.part];
  const Capsule& avatar_hand = *scene.avatar.volume[hand];
  const Capsule& avatar_part = *scene.avatar.volume[touch.part];
  const glm::dvec3 p_in_part = inverse(world_from(source_part, source_joints)) *
                               (source_joints[index(source_hand.joint)] *
                                axis_point_in_joint(source_hand, touch.along_hand));
  const glm::dvec3 wanted =
      shifted_part(scene.avatar, scene.arms, touch.part, shifts, t) *
      carried_over(source_part,
                   p_in_part,
                   source_hand.radius_m,
                   avatar_part,
                   avatar_hand.radius_m);
  const glm::dvec3 is = scene.avatar.frames[t][index(avatar_hand.joint)] *
                        axis_point_in_joint(avatar_hand, touch.along_hand);
  return wanted - (is + shifts[s(touch.side)][t].wrist_m);
}

bool has_parts(const Scene& scene, const Touch& touch) {
  const P hand = on_side(P::kLeftHand, touch.side);
  for (const VolumeInMotion* body : {&scene.source, &scene.avatar}) {
    if (!body->volume[hand] || !body->volume[touch.part]) return false;
  }
  return scene.arms.has(touch.side) && (touch.part != P::kRightHand || scene.arms.has(1));
}

// Frames of a touch and of its fades, in which it is active.
struct Fade {
  int first = 0;
  int last = 0;
  std::vector<double> active;  // From first to last.
};

Fade fade_of(const FrameRange& frames, int frame_count, FrameRate rate, double fade_s) {
  const Activation when = fading(frames, frame_count, 0, rate, fade_s);
  const int around = static_cast<int>(std::ceil(fade_s * rate.hz));
  Fade fade{std::max(frames.first - around, 0),
            std::min(frames.last + around, frame_count - 1),
            {}};
  for (int t = fade.first; t <= fade.last; ++t) {
    const bool within = t >= frames.first && t <= frames.last;
    fade.active.push_back(within ? 1.0 : activation(when, t / rate.hz));
  }
  return fade;
}

// Objective of the next pass of a hold.
enum class Towards {
  kPlace,     // To its target position, as far as other holds leave the hand free.
  kClear,     // Out of trunk and thighs, as far as the source's hand is.
  kDistance,  // To its distance from the part, regardless of other holds.
};

// A touch or a still hand, with the freedom of its hand.
struct Hold {
  const Touch* touch = nullptr;
  const StillHand* still = nullptr;
  int side = 0;
  FrameRange frames;
  Fade fade;
  // Per frame of the fade: freedom of the hand that other holds leave.
  std::vector<double> free;

  [[nodiscard]] bool joins_hands() const { return touch && is_hand(touch->part); }
};

// Extends the error within a hold's frames to a displacement over the whole fade. The
// values at the ends continue before and after, and all is low-passed, so that it adds no
// more acceleration than the fade itself. In axes that rotate with the touched part.
std::vector<glm::dvec3> spread(const std::vector<glm::dvec3>& missing,
                               int before,
                               int after,
                               int half) {
  const int inner = static_cast<int>(missing.size());
  const auto at = [&](int k) {
    return missing[static_cast<std::size_t>(std::clamp(k, 0, inner - 1))];
  };
  const std::vector<double> weights = triweight_weights(half);
  const double sum_of_weights = std::accumulate(weights.begin(), weights.end(), 0.0);
  std::vector<glm::dvec3> out;
  for (int t = -before; t < inner + after; ++t) {
    glm::dvec3 sum(0.0);
    for (int k = -half; k <= half; ++k) {
      sum += weights[static_cast<std::size_t>(k + half)] * at(t + k);
    }
    out.push_back(sum / sum_of_weights);
  }
  return out;
}

struct Keeper {
  const Scene& scene;
  const Arms& source_arms;
  const WorldScale& world;
  StillPlace place;
  int low_pass_half;  // [frames]
  double slack_m;
  HandHolds& holds;
  ArmShifts& shifts;

  [[nodiscard]] glm::dvec3 still_error(int side, std::size_t t) const {
    const auto middle = [&](const VolumeInMotion& body) {
      const Capsule& capsule = *body.volume[on_side(P::kLeftHand, side)];
      return body.frames[t][index(capsule.joint)] * axis_point_in_joint(capsule, 0.0);
    };
    return world.of(middle(scene.source), place) -
           (middle(scene.avatar) + shifts[s(side)][t].wrist_m);
  }

  // Error of the distance of a touch, from the part outwards.
  [[nodiscard]] glm::dvec3 distance_error(const Touch& touch, std::size_t t) const {
    const VolumeInMotion& avatar = scene.avatar;
    const Capsule& hand = *avatar.volume[on_side(P::kLeftHand, touch.side)];
    const RigidTransform world_from_part =
        shifted_part(avatar, scene.arms, touch.part, shifts, t);
    const glm::dvec3 is = avatar.frames[t][index(hand.joint)] *
                              axis_point_in_joint(hand, touch.along_hand) +
                          shifts[s(touch.side)][t].wrist_m;
    const CapsuleSide side =
        side_of(*avatar.volume[touch.part], inverse(world_from_part) * is);
    const VolumeInMotion& source = scene.source;
    const Capsule& source_hand = *source.volume[on_side(P::kLeftHand, touch.side)];
    const auto joints = source.frames[t];
    const double wanted_m =
        side_of(*source.volume[touch.part],
                joints,
                joints[index(source_hand.joint)] *
                    axis_point_in_joint(source_hand, touch.along_hand))
            .distance_m -
        source_hand.radius_m + hand.radius_m;
    return world_from_part.rotation * (side.outward * (wanted_m - side.distance_m));
  }

  [[nodiscard]] glm::dquat axes(const Hold& hold, std::size_t t) const {
    if (!hold.touch) return {1.0, 0.0, 0.0, 0.0};
    const Capsule& part = *scene.avatar.volume[hold.touch->part];
    return scene.avatar.frames[t][index(part.joint)].rotation;
  }

  void take_free(Hold& hold) const {
    for (std::size_t i = 0; i < hold.fade.active.size(); ++i) {
      const std::size_t t = s(hold.fade.first) + i;
      double& held = hold.joins_hands() ? holds.hands[t] : holds.hand[s(hold.side)][t];
      hold.free.push_back(1.0 - held);
      held += (1.0 - held) * hold.fade.active[i];
    }
  }

  [[nodiscard]] glm::dvec3 error(const Hold& hold, Towards towards, std::size_t t) const {
    if (hold.still) return still_error(hold.side, t);
    if (towards == Towards::kPlace) return touch_error(scene, *hold.touch, shifts, t);
    if (towards == Towards::kDistance) return distance_error(*hold.touch, t);
    const ArmShift& shift = shifts[s(hold.side)][t];
    const VolumeInMotion& source = scene.source;
    const VolumeInMotion& avatar = scene.avatar;
    return arm_penetration(
               {source.volume, source.frames[t], source_arms.places(t, hold.side)},
               {avatar.volume, avatar.frames[t], scene.arms.places(t, hold.side, shift)},
               hold.side,
               slack_m)
        .wrist;
  }

  void improve(const Hold& hold, Towards towards) const {
    std::vector<glm::dvec3> missing;
    for (int frame = hold.frames.first; frame <= hold.frames.last; ++frame) {
      const std::size_t t = s(frame);
      missing.push_back(glm::conjugate(axes(hold, t)) * error(hold, towards, t));
    }
    const std::vector<glm::dvec3> way = spread(missing,
                                               hold.frames.first - hold.fade.first,
                                               hold.fade.last - hold.frames.last,
                                               low_pass_half);
    for (std::size_t i = 0; i < way.size(); ++i) {
      const std::size_t t = s(hold.fade.first) + i;
      const double free = towards == Towards::kPlace ? hold.free[i] : 1.0;
      const double share = hold.fade.active[i] * free;
      move(hold, t, share * (axes(hold, t) * way[i]));
    }
  }

  void move(const Hold& hold, std::size_t t, const glm::dvec3& way) const {
    if (!hold.joins_hands()) {
      shifts[s(hold.side)][t].wrist_m += way;
      return;
    }
    const double left = 1.0 - holds.hand[0][t] + kMinFreedom;
    const double right = 1.0 - holds.hand[1][t] + kMinFreedom;
    shifts[0][t].wrist_m += way * (left / (left + right));
    shifts[1][t].wrist_m -= way * (right / (left + right));
  }
};

// Orders holds: static parts first, nearest first; then parts that move with the other
// arm.
std::vector<Hold> holds_of(const Scene& scene,
                           const Touches& touches,
                           FrameRate rate,
                           const KeepTouchesOptions& options) {
  std::vector<Hold> out;
  const auto add = [&](const Touch* touch, const StillHand* still) {
    const int side = touch ? touch->side : still->side;
    const FrameRange& frames = touch ? touch->frames : still->frames;
    out.push_back({touch,
                   still,
                   side,
                   frames,
                   fade_of(frames, touches.frame_count, rate, options.fade_s),
                   {}});
  };
  const auto rank = [](P part) { return !arm_side(part) ? 0 : is_hand(part) ? 1 : 2; };
  std::vector<const Touch*> sorted;
  for (const Touch& touch : touches.touches) {
    if (has_parts(scene, touch)) sorted.push_back(&touch);
  }
  std::stable_sort(sorted.begin(), sorted.end(), [&](const Touch* a, const Touch* b) {
    if (rank(a->part) != rank(b->part)) return rank(a->part) < rank(b->part);
    return a->distance_m < b->distance_m;
  });
  for (const Touch* touch : sorted) {
    if (rank(touch->part) == 0) add(touch, nullptr);
  }
  for (const StillHand& still : touches.still) {
    const P hand = on_side(P::kLeftHand, still.side);
    const bool there = scene.source.volume[hand] && scene.avatar.volume[hand];
    if (!there || !scene.arms.has(still.side) || options.still == StillPlace::kFree) {
      continue;
    }
    add(nullptr, &still);
  }
  for (const Touch* touch : sorted) {
    if (rank(touch->part) != 0) add(touch, nullptr);
  }
  return out;
}

}  // namespace

HandHolds keep_touches(const Touches& touches,
                       const VolumeInMotion& source,
                       const VolumeInMotion& avatar,
                       const Arms& arms,
                       FrameRate rate,
                       const WorldScale& world,
                       const KeepTouchesOptions& options,
                       double slack_m,
                       ArmShifts& shifts) {
  const std::size_t count = avatar.frames.count();
  MAREY_ASSERT(source.frames.count() == count);
  MAREY_ASSERT(touches.frame_count == static_cast<int>(count));
  MAREY_ASSERT(shifts[0].size() == count && shifts[1].size() == count);
  const Scene scene{source, avatar, arms};
  HandHolds holds{{std::vector<double>(count, 0.0), std::vector<double>(count, 0.0)},
                  std::vector<double>(count, 0.0)};
  std::vector<Hold> all = holds_of(scene, touches, rate, options);
  const int half = static_cast<int>(std::lround(options.low_pass_s * 0.5 * rate.hz));
  const Arms source_arms(source.frames, source.map);
  const Keeper keeper{
      scene, source_arms, world, options.still, half, slack_m, holds, shifts};
  for (Hold& hold : all) keeper.take_free(hold);
  for (int pass = 0; pass < kPlacePasses; ++pass) {
    for (const Hold& hold : all) keeper.improve(hold, Towards::kPlace);
  }
  // The nearest hold is last: where one hand cannot satisfy both, the nearest is kept.
  for (int pass = 0; pass < kDistancePasses; ++pass) {
    for (const Hold& hold : all) {
      const bool on_body = hold.touch && !arm_side(hold.touch->part);
      if (on_body && source_arms.has(hold.side)) keeper.improve(hold, Towards::kClear);
    }
    for (auto hold = all.rbegin(); hold != all.rend(); ++hold) {
      if (hold->touch) keeper.improve(*hold, Towards::kDistance);
    }
  }
  return holds;
}

double touch_gap_m(const Touch& touch,
                   const VolumeInMotion& body,
                   const Arms& arms,
                   const ArmShifts& shifts,
                   std::size_t t) {
  const P hand = on_side(P::kLeftHand, touch.side);
  const Capsule& capsule = *body.volume[hand];
  const RigidTransform world_from_hand = shifted_part(body, arms, hand, shifts, t);
  const glm::dvec3 p_in_world =
      world_from_hand * glm::dvec3(0, 0, touch.along_hand * capsule.half_length_m);
  const RigidTransform world_from_part = shifted_part(body, arms, touch.part, shifts, t);
  return side_of(*body.volume[touch.part], inverse(world_from_part) * p_in_world)
             .distance_m -
         capsule.radius_m;
}

}  // namespace marey::retarget
