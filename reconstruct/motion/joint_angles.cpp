// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/motion/joint_angles.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/base/assert.h"
#include "core/pose.h"
#include "reconstruct/motion/joint_rotation.h"

namespace marey::reconstruct {
namespace {

using B = HumanBone;
using C = Coordinate;

constexpr double kPi = std::numbers::pi;

constexpr std::array<std::string_view, kCoordinateCount> kNames{
    "pelvis_tilt",      "pelvis_list",    "pelvis_rotation",  "pelvis_tx",
    "pelvis_ty",        "pelvis_tz",      "hip_flexion_r",    "hip_adduction_r",
    "hip_rotation_r",   "knee_angle_r",   "ankle_angle_r",    "subtalar_angle_r",
    "mtp_angle_r",      "hip_flexion_l",  "hip_adduction_l",  "hip_rotation_l",
    "knee_angle_l",     "ankle_angle_l",  "subtalar_angle_l", "mtp_angle_l",
    "lumbar_extension", "lumbar_bending", "lumbar_rotation",  "arm_flex_r",
    "arm_add_r",        "arm_rot_r",      "elbow_flex_r",     "pro_sup_r",
    "wrist_flex_r",     "wrist_dev_r",    "arm_flex_l",       "arm_add_l",
    "arm_rot_l",        "elbow_flex_l",   "pro_sup_l",        "wrist_flex_l",
    "wrist_dev_l"};

// Rajagopal2016's axes of right joints, in the parent's frame. Left ones are mirrored.
constexpr glm::dvec3 kAnkleAxis{
    -0.1050135495114587, -0.1740224491904174, 0.9791263154449344};
constexpr glm::dvec3 kSubtalarAxis{
    0.7871796068877029, 0.6047474576089907, -0.1209494895217982};
constexpr glm::dvec3 kToesAxis{0.5809543982451424, 0.0, -0.8139361075413872};
/// Yaw of the elbow's axis (0.226, 0.022, 0.974) about the upper arm, from lateral
/// towards the front. The inclination along the arm by 1.3 degrees is ignored.
constexpr double kElbowYawRad = 0.2280752418775282;
/// The right hip centre in the pelvis. [m]
constexpr glm::dvec3 kHipInPelvis{-0.056276, -0.07849, 0.07726};

/// The three angles of a ball joint, with the ranges of the model, and bits of locked
/// frames.
struct Triple {
  C first = C::kPelvisTilt;
  std::array<AngleRange, 3> usual;
};
constexpr std::array<Triple, 8> kTriples{{
    {C::kPelvisTilt, {{{-kPi, kPi}, {-kPi / 2, kPi / 2}, {-kPi, kPi}}}},
    {C::kLumbarExtension,
     {{{-kPi / 2, kPi / 2}, {-kPi / 2, kPi / 2}, {-kPi / 2, kPi / 2}}}},
    {C::kHipFlexionRight, {{{-0.5236, 2.0944}, {-0.8727, 0.5236}, {-0.6981, 0.6981}}}},
    {C::kHipFlexionLeft, {{{-0.5236, 2.0944}, {-0.8727, 0.5236}, {-0.6981, 0.6981}}}},
    {C::kArmFlexionRight,
     {{{-kPi / 2, kPi / 2}, {-2.0944, kPi / 2}, {-kPi / 2, kPi / 2}}}},
    {C::kArmFlexionLeft,
     {{{-kPi / 2, kPi / 2}, {-2.0944, kPi / 2}, {-kPi / 2, kPi / 2}}}},
    {C::kPronationRight, {{{0.0, kPi / 2}, {-1.2217, 1.2217}, {-0.4363, 0.6109}}}},
    {C::kPronationLeft, {{{0.0, kPi / 2}, {-1.2217, 1.2217}, {-0.4363, 0.6109}}}},
}};

/// A side's bones and first coordinates.
struct Side {
  bool left;
  B upper_leg, lower_leg, foot, toes, upper_arm, lower_arm, hand;
  C hip, arm;
};
constexpr std::array<Side, 2> kSides{{
    {false,
     B::kRightUpperLeg,
     B::kRightLowerLeg,
     B::kRightFoot,
     B::kRightToes,
     B::kRightUpperArm,
     B::kRightLowerArm,
     B::kRightHand,
     C::kHipFlexionRight,
     C::kArmFlexionRight},
    {true,
     B::kLeftUpperLeg,
     B::kLeftLowerLeg,
     B::kLeftFoot,
     B::kLeftToes,
     B::kLeftUpperArm,
     B::kLeftLowerArm,
     B::kLeftHand,
     C::kHipFlexionLeft,
     C::kArmFlexionLeft},
}};

glm::dquat about(int axis, double angle_rad) {
  glm::dvec3 v(0.0);
  v[axis] = std::sin(0.5 * angle_rad);
  return {std::cos(0.5 * angle_rad), v.x, v.y, v.z};
}

// Rotation of the right arm from the T-pose to OpenSim's zero pose, in OpenSim's axes:
// down; then the upper arm until its hinge is the model's elbow axis, and forearm and
// hand until the palm faces forward.
constexpr double kHalfRoot = std::numbers::sqrt2 / 2;
constexpr glm::dquat kArmDown{kHalfRoot, kHalfRoot, 0.0, 0.0};
constexpr glm::dquat kHandAtZero{0.5, 0.5, -0.5, 0.5};
glm::dquat upper_arm_at_zero() {
  return about(1, kElbowYawRad) * kArmDown;
}

/// World poses of the bones of a motion, and one frame of them in OpenSim's axes.
class Frame {
 public:
  explicit Frame(const Skeleton& skeleton) : world_from_joint_(skeleton.joints.size()) {
    for (const B bone : human_bones()) {
      const auto joint = skeleton.find(bone);
      MAREY_ASSERT(joint.has_value());
      joints_[index(bone)] = index(*joint);
    }
    for (const Joint& joint : skeleton.joints) {
      MAREY_ASSERT(std::abs(joint.parent_from_joint.rotation.w) > 1.0 - 1e-9);
    }
  }

  void take(const Skeleton& skeleton, const Pose& pose) {
    world_from_joints(skeleton, pose, world_from_joint_);
  }

  [[nodiscard]] const RigidTransform& world_from(B bone) const {
    return world_from_joint_[joints_[index(bone)]];
  }

  /// Returns the rotation of a bone relative to another since the T-pose: X forward, Y
  /// up, Z to the right; for a left one that of its mirror image.
  [[nodiscard]] glm::dquat turn(B parent, B child, bool left) const {
    const glm::dquat q =
        glm::conjugate(world_from(parent).rotation) * world_from(child).rotation;
    if (left) return {q.w, -q.z, -q.y, -q.x};
    return {q.w, q.z, q.y, -q.x};
  }

 private:
  std::array<std::size_t, kHumanBoneCount> joints_{};
  std::vector<RigidTransform> world_from_joint_;
};

/// One row of the result.
class Row {
 public:
  Row(double* values, std::uint16_t& locked) : values_(values), locked_(locked) {}

  double& operator[](C coordinate) { return values_[index(coordinate)]; }
  /// Returns the coordinate `after` places after another.
  double& next(C coordinate, std::size_t after) {
    return values_[index(coordinate) + after];
  }
  void put(C first, const Cardan& cardan) {
    for (std::size_t i = 0; i < 3; ++i) next(first, i) = cardan.angle_rad[i];
    for (std::size_t i = 0; i < kTriples.size(); ++i) {
      if (cardan.locked && kTriples[i].first == first) {
        locked_ = static_cast<std::uint16_t>(locked_ | 1U << i);
      }
    }
  }

 private:
  double* values_;
  std::uint16_t& locked_;
};

void put_pelvis(const Frame& frame, double ground_yaw_rad, Row& row) {
  const glm::dquat ground_from_world = about(1, ground_yaw_rad);
  const RigidTransform& world_from_hips = frame.world_from(B::kHips);
  // The pelvis' X is the hips' Z, its Z is their -X.
  const glm::dquat ground_from_pelvis =
      ground_from_world * world_from_hips.rotation * about(1, -kPi / 2);
  row.put(C::kPelvisTilt, cardan_angles(ground_from_pelvis, kZxy));
  const glm::dvec3 right = frame.world_from(B::kRightUpperLeg).translation;
  const glm::dvec3 left = frame.world_from(B::kLeftUpperLeg).translation;
  const glm::dvec3 p_in_ground =
      ground_from_world * (0.5 * (left + right)) +
      ground_from_pelvis * glm::dvec3(-kHipInPelvis.x, -kHipInPelvis.y, 0.0) *
          (glm::distance(left, right) / (2.0 * kHipInPelvis.z));
  row[C::kPelvisTx] = p_in_ground.x;
  row[C::kPelvisTy] = p_in_ground.y;
  row[C::kPelvisTz] = p_in_ground.z;
}

void put_leg(const Frame& frame, const Side& side, Row& row) {
  row.put(side.hip, cardan_angles(frame.turn(B::kHips, side.upper_leg, side.left), kZxy));
  const auto knee = frame.turn(side.upper_leg, side.lower_leg, side.left);
  row.next(side.hip, 3) = -cardan_angles(knee, kZxy).angle_rad[0];
  const auto foot = frame.turn(side.lower_leg, side.foot, side.left);
  const HingeAngles ankle = nearest_hinges(foot, kAnkleAxis, kSubtalarAxis);
  row.next(side.hip, 4) = ankle.first_rad;
  row.next(side.hip, 5) = ankle.second_rad;
  const auto toes = frame.turn(side.foot, side.toes, side.left);
  row.next(side.hip, 6) = nearest_hinge(toes, kToesAxis);
}

void put_arm(const Frame& frame, const Side& side, Row& row) {
  const auto arm = frame.turn(B::kUpperChest, side.upper_arm, side.left);
  row.put(side.arm, cardan_angles(arm * glm::conjugate(upper_arm_at_zero()), kZxy));
  // Relative to an upper arm that hangs with its hinge straight to the side.
  const auto forearm = frame.turn(side.upper_arm, side.lower_arm, side.left);
  const auto elbow = cardan_angles(kArmDown * forearm * glm::conjugate(kArmDown), kZxy);
  row.next(side.arm, 3) = elbow.angle_rad[0];
  // A forearm and a hand turn about the same axis, and skin shows little of either: the
  // whole turn of the hand about the forearm is pronation.
  const auto hand = frame.turn(side.upper_arm, side.hand, side.left);
  const auto forearm_without_twist =
      about(2, elbow.angle_rad[0]) * about(0, elbow.angle_rad[1]);
  Cardan wrist = cardan_angles(glm::conjugate(forearm_without_twist) * kArmDown * hand *
                                   glm::conjugate(kHandAtZero),
                               kYzx);
  wrist.angle_rad[0] += kElbowYawRad;
  row.put(C{static_cast<int>(side.arm) + 4}, wrist);
}

}  // namespace

std::string_view name(Coordinate coordinate) {
  return kNames[index(coordinate)];
}

bool is_angle(Coordinate coordinate) {
  return coordinate < C::kPelvisTx || coordinate > C::kPelvisTz;
}

JointAngles joint_angles(const Motion& motion, const JointAngleOptions& options) {
  MAREY_ASSERT(motion.rate.hz > 0.0);
  const std::size_t frames = motion.poses.size();
  JointAngles angles;
  angles.values.resize(frames * kCoordinateCount);
  angles.time_s.resize(frames);
  std::vector<std::uint16_t> locked(frames, 0);
  Frame frame(motion.skeleton);
  for (std::size_t i = 0; i < frames; ++i) {
    angles.time_s[i] = (motion.first_frame + static_cast<double>(i)) / motion.rate.hz;
    frame.take(motion.skeleton, motion.poses[i]);
    Row row(&angles.values[i * kCoordinateCount], locked[i]);
    put_pelvis(frame, options.ground_yaw_rad, row);
    row.put(C::kLumbarExtension,
            cardan_angles(frame.turn(B::kHips, B::kUpperChest, false), kZxy));
    for (const Side& side : kSides) {
      put_leg(frame, side, row);
      put_arm(frame, side, row);
    }
  }
  const auto series = [&](std::size_t coordinate) {
    return Series{angles.values.data() + coordinate, kCoordinateCount, frames};
  };
  std::vector<std::uint8_t> way;
  for (unsigned i = 0; i < kTriples.size(); ++i) {
    const std::size_t first = index(kTriples[i].first);
    follow_cardan({series(first), series(first + 1), series(first + 2)},
                  kTriples[i].usual,
                  locked,
                  i,
                  way);
  }
  for (const Side& side : kSides) {
    for (const std::size_t after : {3, 4, 5, 6}) unwrap(series(index(side.hip) + after));
    unwrap(series(index(side.arm) + 3));
  }
  return angles;
}

double yaw_to_face_x_rad(const Motion& motion) {
  const auto hips = motion.skeleton.find(B::kHips);
  MAREY_ASSERT(hips.has_value());
  // The hips are the root, or turn with it.
  std::vector<RigidTransform> world_from_joint(motion.skeleton.joints.size());
  glm::dvec3 facing(0.0);
  for (const Pose& pose : motion.poses) {
    world_from_joints(motion.skeleton, pose, world_from_joint);
    glm::dvec3 forward =
        world_from_joint[index(*hips)].rotation * glm::dvec3(0.0, 0.0, 1.0);
    forward.y = 0.0;
    facing += forward;
  }
  // About +Y by this, X becomes (cos, 0, -sin).
  const double heading_rad = std::atan2(-facing.z, facing.x);
  return -std::round(heading_rad / (kPi / 2)) * (kPi / 2);
}

}  // namespace marey::reconstruct
