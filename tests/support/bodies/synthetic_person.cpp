// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/bodies/synthetic_person.h"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include "core/human/average_proportions.h"

namespace marey::testing {
namespace {

using B = HumanBone;

constexpr double kStature_m = 1.75;

Proportions unusual_proportions() {
  Proportions p = average_proportions(kStature_m);
  for (const B bone : {B::kSpine, B::kChest, B::kUpperChest}) p[bone] *= 1.02;
  p[B::kHead].z = 0.0;  // marey's neck is straight.
  for (const bool left : {true, false}) {
    const auto of_side = [&](B bone) { return left ? bone : mirrored(bone); };
    p[of_side(B::kLeftUpperLeg)].x *= 1.06;
    p[of_side(B::kLeftLowerLeg)] *= 1.04;
    p[of_side(B::kLeftFoot)] *= 1.04;
    p[of_side(B::kLeftUpperArm)] *= 1.03;
    p[of_side(B::kLeftLowerArm)] *= 0.96;
    p[of_side(B::kLeftHand)] *= 0.96;
  }
  p[B::kLeftFoot].y -= 0.003;
  // Toe joints as high above the floor as on an average body.
  const double toes_m = 0.012 * kStature_m;
  p[B::kHips].y = toes_m - p[B::kLeftToes].y - p[B::kLeftFoot].y - p[B::kLeftLowerLeg].y -
                  p[B::kLeftUpperLeg].y;
  return p;
}

/// One tag to be glued on: at `share` of the way to the bone's end, `off_m` off the bone
/// in direction `out`.
struct Plate {
  B segment;
  double share;
  glm::dvec3 out;
  double off_m;
  double size_m;
};

std::vector<Plate> plates() {
  std::vector<Plate> list{{B::kHips, 0.0, {0, 0, 1}, 0.12, 0.09},
                          {B::kHips, 0.0, {0.8, 0, -0.6}, 0.12, 0.09},
                          {B::kHips, 0.0, {-0.8, 0, -0.6}, 0.12, 0.09},
                          {B::kUpperChest, 0.7, {0.1, 0, 1}, 0.12, 0.09},
                          {B::kUpperChest, 0.8, {-0.5, 0, -1}, 0.12, 0.09},
                          {B::kUpperChest, 0.8, {0.5, 0, -1}, 0.12, 0.09},
                          {B::kHead, 0.6, {0, 0, 1}, 0.1, 0.075},
                          {B::kHead, 0.6, {1, 0, -0.4}, 0.09, 0.075},
                          {B::kHead, 0.6, {-1, 0, -0.4}, 0.09, 0.075}};
  for (const bool left : {true, false}) {
    const auto of_side = [&](B bone) { return left ? bone : mirrored(bone); };
    const double side = left ? 1.0 : -1.0;
    list.push_back({of_side(B::kLeftUpperArm), 0.5, {0, 0.7, 0.7}, 0.06, 0.075});
    list.push_back({of_side(B::kLeftUpperArm), 0.6, {0, 0.5, -0.9}, 0.06, 0.075});
    list.push_back({of_side(B::kLeftLowerArm), 0.5, {0, 0.9, 0.4}, 0.05, 0.075});
    list.push_back({of_side(B::kLeftLowerArm), 0.6, {0, -0.4, -0.9}, 0.05, 0.075});
    list.push_back({of_side(B::kLeftHand), 0.5, {0, 1, 0}, 0.03, 0.075});
    list.push_back({of_side(B::kLeftUpperLeg), 0.5, {0.3 * side, 0, 1}, 0.09, 0.09});
    list.push_back({of_side(B::kLeftUpperLeg), 0.6, {1.0 * side, 0, -0.6}, 0.09, 0.09});
    list.push_back({of_side(B::kLeftLowerLeg), 0.5, {0.2 * side, 0, 1}, 0.07, 0.075});
    list.push_back({of_side(B::kLeftLowerLeg), 0.5, {0.8 * side, 0, -0.7}, 0.07, 0.075});
    list.push_back({of_side(B::kLeftFoot), 0.6, {0.2 * side, 1, 0.5}, 0.05, 0.075});
  }
  return list;
}

/// Returns the end of a bone in its own frame.
glm::dvec3 end_of(B bone, const Proportions& p) {
  if (bone == B::kHead) return p.head_top_in_head;
  if (bone == B::kLeftHand) return p.left_hand_tip_in_hand;
  if (bone == B::kRightHand) return p.right_hand_tip_in_hand;
  for (const B child : human_bones()) {
    const auto above = parent(child);
    if (above && *above == bone) return p[child];
  }
  return glm::dvec3(0.0);
}

RigidTransform glue(const Plate& plate, const Proportions& p, Dice& dice) {
  const glm::dvec3 into = -glm::normalize(plate.out);
  const glm::dvec3 helper =
      std::abs(into.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, -1);
  const glm::dvec3 right = glm::normalize(glm::cross(into, helper));
  const glm::dvec3 down = glm::cross(into, right);
  const glm::dquat straight = glm::quat_cast(glm::dmat3(right, down, into));
  const glm::dquat askew =
      rotation_from_vector({0.0, 0.0, dice.between(-0.35, 0.35)}) * dice.turn(0.15);
  return {glm::normalize(straight * askew),
          plate.share * end_of(plate.segment, p) - plate.off_m * into};
}

glm::dquat about(double x_rad, double y_rad, double z_rad) {
  return rotation_from_vector({x_rad, y_rad, z_rad});
}

/// `share` of a rotation.
glm::dquat part(const glm::dquat& rotation, double share) {
  return rotation_from_vector(share * rotation_vector(rotation));
}

/// One posture in the words of anatomy; what it does not say is straight.
struct Attitude {
  glm::dvec3 hips_in_world{0.0};
  glm::dquat hips{1, 0, 0, 0};
  glm::dquat thorax_in_hips{1, 0, 0, 0};
  glm::dquat head_in_thorax{1, 0, 0, 0};
  struct Limb {
    glm::dquat girdle{1, 0, 0, 0};  ///< The collar bone's; legs have none.
    glm::dquat upper{1, 0, 0, 0};
    double flexion_rad = 0.0;
    double twist_rad = 0.0;
    glm::dquat end{1, 0, 0, 0};
  };
  std::array<Limb, 4> limbs;  ///< In the order of human_limbs().
};

Pose pose_of(const Attitude& a) {
  Pose pose;
  pose.root_in_world = a.hips_in_world;
  pose.parent_from_joint.assign(kHumanBoneCount, glm::dquat(1, 0, 0, 0));
  const auto at = [&](B bone) -> glm::dquat& {
    return pose.parent_from_joint[index(bone)];
  };
  at(B::kHips) = a.hips;
  // A spine bends evenly: half of the turn below the chest's upper end, half above.
  at(B::kSpine) = at(B::kChest) = part(a.thorax_in_hips, 0.25);
  at(B::kUpperChest) = part(a.thorax_in_hips, 0.5);
  at(B::kNeck) = at(B::kHead) = part(a.head_in_thorax, 0.5);
  for (std::size_t i = 0; i < a.limbs.size(); ++i) {
    const Attitude::Limb& limb = a.limbs[i];
    const HumanLimb& bones = human_limbs()[i];
    const glm::dvec3 along = i == 0
                                 ? glm::dvec3(1, 0, 0)
                                 : (i == 1 ? glm::dvec3(-1, 0, 0) : glm::dvec3(0, -1, 0));
    if (i < 2) at(*parent(bones.upper)) = limb.girdle;
    at(bones.upper) = limb.upper;
    at(bones.lower) = rotation_from_vector(limb.flexion_rad * bones.hinge_axis) *
                      rotation_from_vector(limb.twist_rad * along);
    at(bones.end) = limb.end;
  }
  return pose;
}

/// A wave of the given period, each `place` in another phase.
double wave(double time_s, double period_s, int place) {
  return std::sin(2.0 * std::numbers::pi * time_s / period_s + 1.9 * place);
}

Attitude exercise(const Proportions& p, double t) {
  Attitude a;
  a.hips_in_world = {0.15 * wave(t, 5.1, 0),
                     p[B::kHips].y - 0.05 + 0.04 * wave(t, 2.7, 1),
                     0.15 * wave(t, 4.3, 2)};
  a.hips = about(0.0, 1.2 * wave(t, 7.0, 3), 0.0) *
           about(0.15 * wave(t, 2.9, 4), 0.0, 0.12 * wave(t, 3.3, 5));
  a.thorax_in_hips =
      about(0.15 + 0.35 * wave(t, 3.1, 6), 0.3 * wave(t, 2.3, 7), 0.2 * wave(t, 2.7, 8));
  a.head_in_thorax =
      about(0.3 * wave(t, 2.1, 9), 0.5 * wave(t, 2.6, 10), 0.2 * wave(t, 3.7, 11));
  for (int i = 0; i < 4; ++i) {
    Attitude::Limb& limb = a.limbs[static_cast<std::size_t>(i)];
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    const int k = 20 + 7 * i;
    if (i < 2) {
      limb.girdle = about(0.0, 0.08 * wave(t, 2.9, k), 0.1 * wave(t, 3.4, k + 1));
      limb.upper = about(0.0, 0.0, side * (-0.9 + 0.7 * wave(t, 2.2, k + 2))) *
                   about(0.0, 0.6 * wave(t, 2.8, k + 3), 0.0) *
                   about(0.4 * wave(t, 3.1, k + 4), 0.0, 0.0);
      limb.flexion_rad = 1.0 + 0.8 * wave(t, 1.9, k + 5);
      limb.twist_rad = 0.3 * wave(t, 2.4, k + 6);
      limb.end = about(
          0.15 * wave(t, 2.0, k), 0.3 * wave(t, 2.5, k + 1), 0.3 * wave(t, 2.3, k + 2));
    } else {
      limb.upper = about(-0.4 + 0.5 * wave(t, 2.2, k),
                         0.2 * wave(t, 2.9, k + 1),
                         side * (0.15 + 0.2 * wave(t, 2.6, k + 2)));
      limb.flexion_rad = 0.8 + 0.6 * wave(t, 1.9, k + 3);
      limb.twist_rad = 0.04 * wave(t, 2.4, k + 4);
      limb.end = about(
          0.3 * wave(t, 2.3, k + 5), 0.1 * wave(t, 2.0, k + 6), 0.1 * wave(t, 2.7, k));
    }
  }
  return a;
}

Attitude step(const Proportions& p, double t) {
  constexpr double kCycle_s = 1.1;
  const auto swing = [&](double phase) {
    return std::sin(2.0 * std::numbers::pi * (t / kCycle_s + phase));
  };
  Attitude a;
  a.hips_in_world = {
      0.02 * swing(0.0),
      p[B::kHips].y - 0.03 + 0.015 * std::sin(4.0 * std::numbers::pi * t / kCycle_s),
      0.8 * (t - 1.0)};
  a.hips = about(0.0, 0.1 * swing(0.1), 0.05 * swing(0.3));
  a.thorax_in_hips = about(0.05, -0.2 * swing(0.1), -0.05 * swing(0.3));
  a.head_in_thorax = about(0.0, 0.1 * swing(0.1), 0.0);
  for (std::size_t i = 0; i < 4; ++i) {
    Attitude::Limb& limb = a.limbs[i];
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    // Left arm with the right leg.
    const double phase = (i == 0 || i == 3) ? 0.5 : 0.0;
    if (i < 2) {
      limb.upper = about(-0.35 * swing(phase), 0.0, 0.0) * about(0.0, 0.0, side * -1.2);
      limb.flexion_rad = 0.45 + 0.2 * swing(phase);
    } else {
      limb.upper = about(-0.1 - 0.4 * swing(phase), 0.0, 0.0);
      limb.flexion_rad = 0.5 + 0.4 * swing(phase - 0.2);
      limb.end = about(0.1 + 0.25 * swing(phase - 0.4), 0.0, 0.0);
    }
  }
  return a;
}

}  // namespace

Body tagged_person() {
  Body body;
  body.name = "truth";
  body.stature_m = kStature_m;
  body.proportions = unusual_proportions();
  Dice dice(29);
  int id = 40;
  for (const Plate& plate : plates()) {
    const TagOnSegment tag{TagId{id++}, plate.segment, plate.size_m};
    body.tags.push_back({tag, glue(plate, body.proportions, dice), 0.0, 0.0, 1});
  }
  return body;
}

Movement standing(const Body& body) {
  Attitude a;
  a.hips_in_world = {0.05, body.proportions[B::kHips].y, -0.1};
  a.hips = about(0.0, 0.3, 0.0);
  for (std::size_t i = 0; i < 2; ++i) {
    a.limbs[i].upper = about(0.0, 0.0, (i == 0 ? -1.0 : 1.0) * glm::radians(70.0));
  }
  return [pose = pose_of(a)](double) { return pose; };
}

Movement range_of_motion(const Body& body) {
  return [p = body.proportions](double time_s) { return pose_of(exercise(p, time_s)); };
}

Movement walking(const Body& body) {
  return [p = body.proportions](double time_s) { return pose_of(step(p, time_s)); };
}

std::vector<CameraDetections> film(const Body& body,
                                   const Movement& movement,
                                   const std::vector<Camera>& cameras,
                                   const Film& film) {
  const Skeleton skeleton = make_humanoid(body.proportions);
  auto out = unseeing(cameras, film.frames, film.hz, film.trial);
  Dice dice(1882);
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    const double offset_s = film.offsets_s.empty() ? 0.0 : film.offsets_s[c];
    for (int f = 0; f < film.frames; ++f) {
      const auto world_from_bone =
          world_from_joints(skeleton, movement(f / film.hz + offset_s));
      for (const PlacedTag& placed : body.tags) {
        if (film.hidden && film.hidden(placed.tag, f)) continue;
        const RigidTransform world_from_tag =
            world_from_bone[index(placed.tag.segment)] * placed.segment_from_tag;
        const auto tag =
            see_tag(cameras[c], world_from_tag, placed.tag.id, placed.tag.size_m);
        if (!tag) continue;
        out[c].frames[static_cast<std::size_t>(f)].tags.push_back(
            disturbed(*tag, film.disturbance, dice));
      }
    }
  }
  return out;
}

std::vector<TagOnSegment> tags_of(const Body& body) {
  std::vector<TagOnSegment> tags;
  for (const PlacedTag& placed : body.tags) tags.push_back(placed.tag);
  return tags;
}

const std::vector<HumanBone>& limb_joints() {
  static const std::vector<HumanBone> joints = [] {
    std::vector<HumanBone> list;
    for (const HumanLimb& limb : human_limbs()) {
      list.insert(list.end(), {limb.upper, limb.lower, limb.end});
    }
    return list;
  }();
  return joints;
}

}  // namespace marey::testing
