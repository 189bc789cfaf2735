// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/bones/neutral_bones.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "core/base/degrees.h"
#include "core/pose.h"
#include "core/transform.h"
#include "retarget/bones/body_places.h"
#include "retarget/bones/skeleton_tree.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

// Minimum cosine between a bone and an axis of its own joint for the bone to lie along
// it.
constexpr double kNearAxis = 0.82;       // Cosine of 35 degrees.
constexpr double kNearSideAxis = 0.966;  // Cosine of 15 degrees.
// Bones of a limb that lie within 35 degrees of one line are straight in the file's rest.
constexpr double kMinStraightness = 0.82;
// Minimum mean sine of the bend of elbows and knees that determines their hinge.
constexpr double kMinBend = 0.02;
constexpr double kMinLength_m = 1e-9;

const glm::dvec3 kLeft(1, 0, 0);
const glm::dvec3 kUp(0, 1, 0);
const glm::dvec3 kFront(0, 0, 1);

glm::dvec3 across(const glm::dvec3& v, const glm::dvec3& axis) {
  return unit_of(v - axis * glm::dot(v, axis));
}

/// Returns the joint's own axis that is as near to a direction, or the direction.
glm::dvec3 nearest_axis(const glm::dvec3& direction, double cosine) {
  return snapped(unit_of(direction), cosine);
}

/// Returns directions across `along`: the joint's own axes that are not along it, or
/// every `step` radians from the first of these.
std::vector<glm::dvec3> turns_about(const glm::dvec3& along, double step_rad) {
  glm::dvec3 first(0.0);
  for (int axis = 0; axis < 3 && first == glm::dvec3(0.0); ++axis) {
    glm::dvec3 own(0.0);
    own[axis] = 1.0;
    if (std::abs(glm::dot(own, along)) < 0.6) first = across(own, along);
  }
  std::vector<glm::dvec3> turns;
  const int count = static_cast<int>(std::lround(2.0 * std::numbers::pi / step_rad));
  for (int i = 0; i < count; ++i) {
    turns.push_back(glm::angleAxis(i * step_rad, along) * first);
  }
  return turns;
}

class TPose {
 public:
  TPose(const Skeleton& skeleton,
        const FoundBones& found,
        const NeutralEvidence& evidence,
        double foot_pitch_rad)
      : tree_(skeleton),
        found_(found),
        evidence_(evidence),
        foot_pitch_(foot_pitch_rad),
        zero_(world_from_joints(skeleton, rest_pose(skeleton))),
        t_pose_(skeleton.joints.size()),
        is_set_(skeleton.joints.size(), false) {}

  std::vector<glm::dquat> make() {
    place_hips();
    place_trunk();
    for (std::size_t i = 0; i < 4; ++i) place_limb(i);
    place_rest();
    return std::move(t_pose_);
  }

 private:
  /// Vector from a joint to another below it, in the joint's own frame, as the file
  /// rests. Summed bone by bone, so that the position of the file's root has no
  /// influence, not even by rounding.
  [[nodiscard]] glm::dvec3 way(JointIndex from, JointIndex to) const {
    glm::dvec3 place(0.0);
    auto at = std::optional(to);
    for (; at && *at != from; at = tree_.parent(*at)) {
      place = tree_.skeleton()[*at].parent_from_joint * place;
    }
    if (at) return place;
    return glm::conjugate(zero_[index(from)].rotation) *
           (zero_[index(to)].translation - zero_[index(from)].translation);
  }

  void set(JointIndex joint, const glm::dquat& t_pose) {
    t_pose_[index(joint)] = glm::normalize(t_pose);
    is_set_[index(joint)] = true;
  }

  /// Rotation that puts `along` of a frame along `to`, and `lateral` towards `side`.
  static glm::dquat turned(const glm::dvec3& along,
                           const glm::dvec3& to,
                           const glm::dvec3& lateral,
                           const glm::dvec3& side) {
    const glm::dvec3 b = across(lateral, along);
    const glm::dvec3 s = across(side, to);
    const glm::dmat3 own(along, b, glm::cross(along, b));
    const glm::dmat3 there(to, s, glm::cross(to, s));
    return glm::normalize(glm::quat_cast(there * glm::transpose(own)));
  }

  /// A joint that is not set yet keeps its rotation relative to its parent.
  [[nodiscard]] glm::dquat t_pose_of(JointIndex joint) const {
    std::vector<JointIndex> open;
    auto at = std::optional(joint);
    while (at && !is_set_[index(*at)]) {
      open.push_back(*at);
      at = tree_.parent(*at);
    }
    if (!at) return {1.0, 0.0, 0.0, 0.0};
    glm::dquat turn = t_pose_[index(*at)];
    JointIndex above = *at;
    for (auto it = open.rbegin(); it != open.rend(); ++it) {
      turn = turn * glm::conjugate(zero_[index(above)].rotation) *
             zero_[index(*it)].rotation;
      above = *it;
    }
    return glm::normalize(turn);
  }

  /// Direction of the T-pose in a joint's frame, computed through its parent as the mean
  /// over all frames.
  [[nodiscard]] glm::dvec3 expected(JointIndex joint, const glm::dvec3& direction) const {
    const auto parent = tree_.parent(joint);
    if (!parent) return direction;
    return evidence_.joint_from_parent[index(joint)] *
           (glm::conjugate(t_pose_of(*parent)) * direction);
  }

  /// Similarity of a joint with this T-pose to its parent, as the mean over all frames.
  [[nodiscard]] double likelihood(JointIndex joint, const glm::dquat& t_pose) const {
    double sum = 0.0;
    for (const glm::dvec3& axis : {kLeft, kUp, kFront}) {
      sum += glm::dot(glm::conjugate(t_pose) * axis, expected(joint, axis));
    }
    return sum;
  }

  [[nodiscard]] static glm::dvec3 likeliest(const std::vector<glm::dvec3>& choices,
                                            const glm::dvec3& expected) {
    return *std::ranges::max_element(
        choices, {}, [&](const glm::dvec3& c) { return glm::dot(c, expected); });
  }

  /// The joint's own axis in a direction of the T-pose.
  [[nodiscard]] glm::dvec3 own_axis(JointIndex joint, const glm::dvec3& direction) const {
    std::vector<glm::dvec3> axes;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sign : {1.0, -1.0}) {
        glm::dvec3 own(0.0);
        own[axis] = sign;
        axes.push_back(own);
      }
    }
    return likeliest(axes, expected(joint, direction));
  }

  /// Puts `along` along `to`; the rotation about it follows from the relative rotation of
  /// joint and parent. Motions with disturbed joints do not determine it; then `prior`
  /// decides, the likely direction of `side` in the joint's frame, unless it is zero.
  void set_by_parent(JointIndex joint,
                     const glm::dvec3& along,
                     const glm::dvec3& to,
                     const glm::dvec3& side,
                     const glm::dvec3& prior = glm::dvec3(0.0)) {
    // Two choices differ by at least 2 if the joint stays near its parent.
    constexpr double kPrior = 1.5;
    const bool is_axis = snapped(along, 0.97) != along || snapped(along, 1.0) == along;
    glm::dquat best(1.0, 0.0, 0.0, 0.0);
    double max_likelihood = -std::numeric_limits<double>::infinity();
    for (const glm::dvec3& lateral :
         turns_about(along, (is_axis ? 90.0 : 30.0) * kRadiansPerDegree)) {
      const glm::dquat t_pose = turned(along, to, lateral, side);
      const bool is_prior = glm::dot(glm::conjugate(t_pose) * side, prior) > 0.9;
      const double likely =
          likelihood(joint, t_pose) + (is_prior ? kPrior * evidence_.frames : 0.0);
      if (likely <= max_likelihood) continue;
      max_likelihood = likely;
      best = t_pose;
    }
    set(joint, best);
  }

  void place_hips() {
    const JointIndex hips = *found_.joint(B::kHips);
    const glm::dvec3 left = way(hips, *found_.joint(B::kLeftUpperLeg));
    const glm::dvec3 right = way(hips, *found_.joint(B::kRightUpperLeg));
    const glm::dvec3 side = nearest_axis(left - right, kNearSideAxis);
    glm::dvec3 up = -0.5 * (left + right);
    if (const auto next = first_of_trunk()) up += way(hips, *next);
    up = across(nearest_axis(across(up, side), kNearAxis), side);
    set(hips, turned(up, kUp, side, kLeft));
  }

  [[nodiscard]] std::optional<JointIndex> top() const {
    for (const B bone : {B::kHead, B::kNeck, B::kUpperChest, B::kChest, B::kSpine}) {
      if (const auto joint = found_.joint(bone)) return joint;
    }
    return std::nullopt;
  }

  /// Joints from the hips to the top, without the hips.
  [[nodiscard]] std::vector<JointIndex> trunk() const {
    const JointIndex hips = *found_.joint(B::kHips);
    const auto end = top();
    if (!end || !tree_.is_below(*end, hips)) return {};
    std::vector<JointIndex> chain = tree_.between(hips, *end);
    chain.push_back(*end);
    return chain;
  }

  [[nodiscard]] std::optional<JointIndex> first_of_trunk() const {
    const auto chain = trunk();
    return chain.empty() ? std::nullopt : std::optional(chain.front());
  }

  /// Direction from the right to the left arm, in a joint that carries both; zero
  /// without.
  [[nodiscard]] glm::dvec3 to_left_arm(JointIndex joint) const {
    for (const auto& [left_bone, right_bone] :
         {std::pair{B::kLeftShoulder, B::kRightShoulder},
          std::pair{B::kLeftUpperArm, B::kRightUpperArm}}) {
      const auto left = found_.joint(left_bone);
      const auto right = found_.joint(right_bone);
      if (!left || !right) continue;
      if (tree_.parent(*left) != joint || tree_.parent(*right) != joint) continue;
      const glm::dvec3 apart = way(joint, *left) - way(joint, *right);
      if (glm::length(apart) > kMinLength_m) return unit_of(apart);
    }
    return glm::dvec3(0.0);
  }

  void place_trunk() {
    const auto chain = trunk();
    for (std::size_t i = 0; i < chain.size(); ++i) {
      const JointIndex joint = chain[i];
      glm::dvec3 up(0.0);
      if (i + 1 < chain.size()) {
        up = way(joint, chain[i + 1]);
      } else if (const auto tip = tree_.skeleton()[joint].tip_in_joint) {
        up = *tip;
      }
      up = glm::length(up) > kMinLength_m ? nearest_axis(up, kNearAxis)
                                          : own_axis(joint, kUp);
      const glm::dvec3 side = to_left_arm(joint);
      if (std::abs(glm::dot(side, up)) > 0.5 || side == glm::dvec3(0.0)) {
        set_by_parent(joint, up, kUp, kLeft);
      } else {
        set(joint, turned(up, kUp, nearest_axis(side, kNearSideAxis), kLeft));
      }
    }
  }

  void place_limb(std::size_t which) {
    const HumanLimb& limb = human_limbs()[which];
    const auto upper = found_.joint(limb.upper);
    const auto lower = found_.joint(limb.lower);
    const auto end = found_.joint(limb.end);
    if (!upper || !lower || !end) return;
    const double left = which % 2 == 0 ? 1.0 : -1.0;
    const glm::dvec3 to = which < 2 ? left * kLeft : -kUp;
    if (which < 2) place_shoulder(which == 0 ? B::kLeftShoulder : B::kRightShoulder, to);
    const glm::dvec3 upper_bone = unit_of(way(*upper, *lower));
    const glm::dvec3 lower_bone = unit_of(way(*lower, *end));
    if (upper_bone == glm::dvec3(0.0) || lower_bone == glm::dvec3(0.0)) return;
    place_hinged(*upper, upper_bone, to, limb.hinge_axis, evidence_.hinge[which][0]);
    const glm::dvec3 straight =
        t_pose_of(*upper) * (glm::conjugate(zero_[index(*upper)].rotation) *
                             (zero_[index(*lower)].rotation * lower_bone));
    if (glm::dot(straight, to) > kMinStraightness) {
      set(*lower, rotation_between(straight, to) * t_pose_of(*lower));
    } else {
      place_hinged(*lower, lower_bone, to, limb.hinge_axis, evidence_.hinge[which][1]);
    }
    if (which < 2) {
      place_hand(*end, to);
    } else {
      place_foot(*end, which == 2 ? B::kLeftToes : B::kRightToes);
    }
  }

  void place_shoulder(B bone, const glm::dvec3& to) {
    const auto shoulder = found_.joint(bone);
    const B arm_bone = bone == B::kLeftShoulder ? B::kLeftUpperArm : B::kRightUpperArm;
    const auto arm = found_.joint(arm_bone);
    if (!shoulder || !arm) return;
    const glm::dvec3 along = way(*shoulder, *arm);
    if (glm::length(along) < kMinLength_m) return;
    set_by_parent(*shoulder, nearest_axis(along, kNearAxis), to, kUp);
  }

  void place_hinged(JointIndex joint,
                    const glm::dvec3& along,
                    const glm::dvec3& to,
                    const glm::dvec3& hinge_axis,
                    const glm::dvec3& hinge) {
    glm::dvec3 likely = hinge;
    if (glm::length(hinge) < kMinBend * evidence_.frames)
      likely = expected(joint, hinge_axis);
    const auto choices = turns_about(along, 30.0 * kRadiansPerDegree);
    set(joint, turned(along, to, likeliest(choices, likely), hinge_axis));
  }

  /// The joint's longest bone, in its frame; zero without one.
  [[nodiscard]] glm::dvec3 longest_bone(JointIndex joint) const {
    glm::dvec3 bone(0.0);
    for (const JointIndex child : tree_.children(joint)) {
      const glm::dvec3 one = way(joint, child);
      if (glm::length(one) > glm::length(bone)) bone = one;
    }
    const auto& tip = tree_.skeleton()[joint].tip_in_joint;
    if (tip && glm::length(*tip) > glm::length(bone)) bone = *tip;
    return glm::length(bone) > kMinLength_m ? unit_of(bone) : glm::dvec3(0.0);
  }

  void place_hand(JointIndex hand, const glm::dvec3& to) {
    const glm::dquat kept = t_pose_of(hand);
    const glm::dvec3 bone = longest_bone(hand);
    if (bone == glm::dvec3(0.0) || glm::dot(kept * bone, to) > kMinStraightness) {
      set(hand, kept);
    } else {
      set_by_parent(hand, nearest_axis(bone, kNearAxis), to, kUp);
    }
  }

  void place_foot(JointIndex foot, B toes_bone) {
    const auto toes = found_.joint(toes_bone);
    const glm::dvec3 bone = toes ? unit_of(way(foot, *toes)) : longest_bone(foot);
    if (bone == glm::dvec3(0.0)) {
      set_by_parent(foot, own_axis(foot, kFront), kFront, kLeft);
      return;
    }
    const glm::dvec3 down = std::cos(foot_pitch_) * kFront - std::sin(foot_pitch_) * kUp;
    // An ankle bends about the same axis as its knee.
    const JointIndex shin = *tree_.parent(foot);
    const glm::dvec3 hinge =
        glm::conjugate(zero_[index(foot)].rotation) *
        (zero_[index(shin)].rotation * (glm::conjugate(t_pose_of(shin)) * kLeft));
    const glm::dvec3 prior =
        std::abs(glm::dot(hinge, bone)) < 0.3 ? across(hinge, bone) : glm::dvec3(0.0);
    set_by_parent(foot, bone, down, kLeft, prior);
    if (!toes) return;
    // The direction of the foot's bone: some toe joints lie aside.
    const glm::dvec3 toe_bone = glm::conjugate(zero_[index(*toes)].rotation) *
                                (zero_[index(foot)].rotation * bone);
    set_by_parent(*toes, nearest_axis(toe_bone, kNearAxis), kFront, kLeft);
  }

  /// All other joints keep their rotation relative to their parent; joints above the hips
  /// keep their world rotation.
  void place_rest() {
    for (std::size_t i = 0; i < t_pose_.size(); ++i) {
      const JointIndex joint{static_cast<int>(i)};
      if (!is_set_[i]) set(joint, t_pose_of(joint));
    }
  }

  SkeletonTree tree_;
  const FoundBones& found_;
  const NeutralEvidence& evidence_;
  double foot_pitch_;
  std::vector<RigidTransform> zero_;
  std::vector<glm::dquat> t_pose_;
  std::vector<bool> is_set_;
};

}  // namespace

std::vector<glm::dquat> t_pose_of_bones(const Skeleton& skeleton,
                                        const FoundBones& found,
                                        const NeutralEvidence& evidence,
                                        double foot_pitch_rad) {
  return TPose(skeleton, found, evidence, foot_pitch_rad).make();
}

}  // namespace marey::retarget
