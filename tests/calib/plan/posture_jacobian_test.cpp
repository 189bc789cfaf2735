// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Compares the posture Jacobian of a planned body with core's forward kinematics.
#include "calib/plan/posture_jacobian.h"

#include <array>
#include <cmath>
#include <initializer_list>
#include <vector>

#include <Eigen/Dense>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/pose.h"

namespace marey::calib {
namespace {

TEST(PostureJacobian, TurnsABodyAsForwardKinematicsDo) {
  const PlannedBody body = make_planned_body(1.75, {});
  constexpr double kTurn_rad = 1e-5;
  const BodyPlace before = walking_body(body, {0.0, 0.0}, 0.4, 1.0);
  const BodyPlace after = walking_body(body, {0.0, 0.0}, 0.4 + kTurn_rad, 1.0);
  const PostureJacobian jacobian = posture_jacobian(body, before);
  // Rotates all bones about the world's Y; elbows and knees keep their angles.
  PostureVector step = PostureVector::Zero();
  for (const int column : {3, 6, 9, 12, 15, 18, 21}) step[column + 1] = kTurn_rad;
  for (int limb = 0; limb < 4; ++limb) {
    step[24 + 9 * limb + 1] = kTurn_rad;
    step[24 + 9 * limb + 7] = kTurn_rad;
  }
  for (const HumanBone bone : human_bones()) {
    const Eigen::Vector3d moved = jacobian.origin[index(bone)] * step;
    const glm::dvec3 truth =
        after[index(bone)].translation - before[index(bone)].translation;
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(moved[axis], truth[axis], 1e-9) << name(bone);
    }
  }
}

/// Returns a body with the given world rotations: positions by core's kinematics.
BodyPlace with_rotations(const PlannedBody& body, const BodyPlace& place) {
  std::vector<glm::dquat> rotations;
  for (const RigidTransform& world_from_bone : place) {
    rotations.push_back(world_from_bone.rotation);
  }
  const Skeleton skeleton = make_humanoid(body.proportions);
  const Pose pose = pose_from_world(skeleton, place[0].translation, rotations);
  BodyPlace out;
  world_from_joints(skeleton, pose, out);
  return out;
}

/// Flexes a limb by `more_rad`, with its end on the frame's axis.
void bend(const PlannedBody& body, std::size_t limb, double more_rad, BodyPlace& place) {
  const HumanLimb& bones = human_limbs()[limb];
  const double upper_m = glm::length(body.proportions[bones.lower]);
  const double lower_m = glm::length(body.proportions[bones.end]);
  const auto lean = [&](double flexion) {
    return std::atan2(lower_m * std::sin(flexion), upper_m + lower_m * std::cos(flexion));
  };
  const auto about_hinge = [&](double angle_rad) {
    return rotation_from_vector(angle_rad * bones.hinge_axis);
  };
  glm::dquat& upper = place[index(bones.upper)].rotation;
  glm::dquat& lower = place[index(bones.lower)].rotation;
  const double flexion = glm::length(rotation_vector(glm::conjugate(upper) * lower));
  const glm::dquat frame = upper * about_hinge(lean(flexion));
  upper = frame * about_hinge(-lean(flexion + more_rad));
  lower = frame * about_hinge(flexion + more_rad - lean(flexion + more_rad));
}

void turn(BodyPlace& place,
          int axis,
          double angle_rad,
          std::initializer_list<HumanBone> bones) {
  glm::dvec3 vector_rad(0.0);
  vector_rad[axis] = angle_rad;
  for (const HumanBone bone : bones) {
    glm::dquat& rotation = place[index(bone)].rotation;
    rotation = rotation_from_vector(vector_rad) * rotation;
  }
}

/// Returns the body after a step of one column of a posture, as defined in
/// calib/plan/posture_jacobian.h.
BodyPlace stepped(const PlannedBody& body, BodyPlace place, int column, double step) {
  using B = HumanBone;
  const int axis = column % 3;
  if (column < 3) {
    place[0].translation[axis] += step;
  } else if (column < 24) {
    constexpr std::array<B, 7> kTurned{B::kHips,
                                       B::kChest,
                                       B::kUpperChest,
                                       B::kNeck,
                                       B::kHead,
                                       B::kLeftShoulder,
                                       B::kRightShoulder};
    turn(place, axis, step, {kTurned[static_cast<std::size_t>(column / 3 - 1)]});
    // The spine's joint takes half of the rotation of both sides.
    if (column < 9) turn(place, axis, 0.5 * step, {B::kSpine});
  } else {
    const auto limb = static_cast<std::size_t>((column - 24) / 9);
    const HumanLimb& bones = human_limbs()[limb];
    const int at = (column - 24) % 9;
    const auto twist = [&](B bone, B next) {
      glm::dquat& rotation = place[index(bone)].rotation;
      rotation =
          rotation * rotation_from_vector(step * glm::normalize(body.proportions[next]));
    };
    if (at < 3) turn(place, axis, step, {bones.upper, bones.lower});
    if (at == 3) bend(body, limb, step, place);
    if (at == 4) twist(bones.upper, bones.lower);
    if (at == 5) twist(bones.lower, bones.end);
    if (at >= 6) turn(place, axis, step, {bones.end});
    if (at >= 6 && limb == 2) turn(place, axis, step, {B::kLeftToes});
    if (at >= 6 && limb == 3) turn(place, axis, step, {B::kRightToes});
  }
  return with_rotations(body, place);
}

TEST(PostureJacobian, IsTheDerivativeOfForwardKinematicsByEveryColumn) {
  const PlannedBody body = make_planned_body(1.75, {});
  const BodyPlace place = walking_body(body, {0.3, -0.2}, 0.4, 1.0);
  const PostureJacobian jacobian = posture_jacobian(body, place);
  constexpr double kStep = 1e-5;
  for (int column = 0; column < kPostureColumns; ++column) {
    const BodyPlace more = stepped(body, place, column, kStep);
    const BodyPlace less = stepped(body, place, column, -kStep);
    for (const HumanBone bone : human_bones()) {
      const auto& [turned, moved] = more[index(bone)];
      const glm::dvec3 by_origin =
          (moved - less[index(bone)].translation) / (2.0 * kStep);
      const glm::dvec3 spin =
          rotation_vector(turned * glm::conjugate(less[index(bone)].rotation)) /
          (2.0 * kStep);
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(jacobian.origin[index(bone)](axis, column), by_origin[axis], 1e-8)
            << name(bone) << " by column " << column;
        EXPECT_NEAR(jacobian.spin[index(bone)](axis, column), spin[axis], 1e-8)
            << name(bone) << " by column " << column;
      }
    }
  }
}

TEST(PostureJacobian, IsTheDerivativeByEveryLengthAndCollarBase) {
  using B = HumanBone;
  const PlannedBody body = make_planned_body(1.75, {});
  const BodyPlace place = walking_body(body, {0.3, -0.2}, 0.4, 1.0);
  const PostureJacobian jacobian = posture_jacobian(body, place);
  constexpr double kStep_m = 1e-5;
  const auto check = [&](const auto& by, int column, const auto& change) {
    PlannedBody longer = body;
    change(longer.proportions);
    const BodyPlace moved = with_rotations(longer, place);
    for (const B bone : human_bones()) {
      const glm::dvec3 truth =
          (moved[index(bone)].translation - place[index(bone)].translation) / kStep_m;
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(by[index(bone)](axis, column), truth[axis], 1e-8)
            << name(bone) << " by column " << column;
      }
    }
  };
  const auto stretch = [&](int column, B bone, const glm::dvec3& way) {
    check(jacobian.origin_by_length, column, [&](Proportions& p) {
      p[bone] += kStep_m * way;
      if (bone == B::kLeftUpperLeg) p[B::kRightUpperLeg] -= kStep_m * way;
    });
  };
  int column = 0;
  for (const B bone : {B::kSpine, B::kChest, B::kUpperChest, B::kNeck, B::kHead}) {
    stretch(column++, bone, {0, 1, 0});
  }
  stretch(column++, B::kLeftUpperLeg, {1, 0, 0});
  for (const B left : {B::kLeftUpperArm,
                       B::kLeftLowerArm,
                       B::kLeftHand,
                       B::kLeftLowerLeg,
                       B::kLeftFoot}) {
    for (const B bone : {left, mirrored(left)}) {
      stretch(column++, bone, glm::normalize(body.proportions[bone]));
    }
  }
  EXPECT_EQ(column, kLengthColumns);
  for (column = 0; column < kBaseColumns; ++column) {
    check(jacobian.origin_by_base, column, [&](Proportions& p) {
      p[column < 3 ? B::kLeftShoulder : B::kRightShoulder][column % 3] += kStep_m;
    });
  }
}

}  // namespace
}  // namespace marey::calib
