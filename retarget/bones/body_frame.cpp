// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/bones/body_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "core/pose.h"
#include "retarget/bones/body_places.h"
#include "retarget/bones/skeleton_tree.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

constexpr double kUsualStature_m = 1.7;
// From average_proportions(): hip to knee to ankle, and hip centres to the head joint.
constexpr double kLegsAndTrunk = 0.491 + 0.355;
constexpr double kNearUp = 0.94;      // Cosine of 20 degrees.
constexpr double kNearFront = 0.978;  // Cosine of 12 degrees.
constexpr std::string_view kSetInMap =
    "set it in a bone map (marey inspect FILE --write-map writes one)";

BodyPlaces rest_places(const SkeletonTree& tree, const FoundBones& found) {
  return body_places(found, [&](JointIndex joint) { return tree.place(joint); });
}

bool stands(const BodyPlaces& p) {
  const glm::dvec3 up = unit_of(p.mid_hip() - p.mid_foot());
  const glm::dvec3 left = unit_of(p.hip[0] - p.foot[0]);
  const glm::dvec3 right = unit_of(p.hip[1] - p.foot[1]);
  // Legs up to 90 degrees apart, hips not above each other, the head above the hips.
  const bool legs = glm::dot(left, right) > 0.0 && glm::dot(left, up) > 0.7 &&
                    glm::dot(right, up) > 0.7;
  const bool side_by_side = std::abs(glm::dot(unit_of(p.hip[0] - p.hip[1]), up)) < 0.5;
  const bool head = !p.head || glm::dot(unit_of(*p.head - p.hips), up) > 0.5;
  return legs && side_by_side && head;
}

/// Returns the lower end of a front leg if the body stands on its hands with a level
/// back.
std::optional<JointIndex> front_foot(const SkeletonTree& tree,
                                     const FoundBones& found,
                                     const BodyPlaces& p) {
  const auto left = found.joint(B::kLeftHand);
  const auto right = found.joint(B::kRightHand);
  const auto arm = found.joint(B::kLeftUpperArm);
  if (!left || !right || !arm) return std::nullopt;
  const glm::dvec3 leg = p.mid_hip() - p.mid_foot();
  const double length = glm::length(leg);
  const glm::dvec3 up = unit_of(leg);
  const auto height = [&](JointIndex joint) {
    return glm::dot(tree.place(joint) - p.mid_foot(), up);
  };
  const bool low = height(*left) < 0.4 * length && height(*right) < 0.4 * length;
  const bool level = glm::dot(unit_of(tree.place(*arm) - p.mid_hip()), up) < 0.6;
  return low && level ? left : std::nullopt;
}

Status check_stands(const SkeletonTree& tree,
                    const FoundBones& found,
                    const BodyPlaces& p) {
  if (const auto paw = front_foot(tree, found, p)) {
    return bad_input("skeleton",
                     "the body stands on four legs: " + tree.quoted(*paw) +
                         " is as low as its feet and its back is level",
                     "use a body that stands on two legs");
  }
  if (stands(p)) return Done{};
  return bad_input("skeleton",
                   "at rest the feet " + tree.quoted(*found.joint(B::kLeftFoot)) +
                       " and " + tree.quoted(*found.joint(B::kRightFoot)) +
                       " are not below the hips " + tree.quoted(*found.joint(B::kHips)) +
                       ", or its head is not above them",
                   "use a file that stands at rest (in a T- or A-pose) or contains a "
                   "motion, or " +
                       std::string(kSetInMap));
}

/// Returns the level direction of both feet; zero if it cannot be determined.
glm::dvec3 toes_direction(const SkeletonTree& tree,
                          const FoundBones& found,
                          const glm::dvec3& up) {
  glm::dvec3 sum(0.0);
  for (const auto& [foot_bone, toes_bone] :
       {std::pair{B::kLeftFoot, B::kLeftToes}, {B::kRightFoot, B::kRightToes}}) {
    const JointIndex foot = *found.joint(foot_bone);
    const auto toes = found.joint(toes_bone);
    std::optional<glm::dvec3> end;
    if (toes) end = tree.place(*toes);
    if (const auto tip = tree.tip(toes ? *toes : foot)) end = tip;
    if (!end) continue;
    const glm::dvec3 bone = *end - tree.place(foot);
    const glm::dvec3 level = bone - up * glm::dot(bone, up);
    if (glm::length(level) > 0.25 * glm::length(bone)) sum += unit_of(level);
  }
  return glm::length(sum) > 0.5 ? unit_of(sum) : glm::dvec3(0.0);
}

void exchange_sides(FoundBones& found) {
  for (const B bone : human_bones()) {
    if (index(mirrored(bone)) > index(bone)) {
      std::swap(found.bones[index(bone)], found.bones[index(mirrored(bone))]);
    }
  }
}

/// Exchanges arms that were found by shape if their left is not on the legs' left.
void align_arms(const SkeletonTree& tree, const glm::dvec3& left, FoundBones& found) {
  const auto left_arm = found.joint(B::kLeftUpperArm);
  const auto right_arm = found.joint(B::kRightUpperArm);
  if (!left_arm || !right_arm) return;
  if (glm::dot(tree.place(*left_arm) - tree.place(*right_arm), left) >= 0.0) return;
  for (const B bone :
       {B::kLeftShoulder, B::kLeftUpperArm, B::kLeftLowerArm, B::kLeftHand}) {
    std::swap(found.bones[index(bone)], found.bones[index(mirrored(bone))]);
  }
}

Error wrong_side(const SkeletonTree& tree,
                 const FoundBones& found,
                 B left_bone,
                 const std::string& why) {
  return bad_input("skeleton",
                   tree.quoted(*found.joint(left_bone)) + " is identified as " +
                       std::string(name(left_bone)) +
                       " but is on the right of the "
                       "body, " +
                       why,
                   "exchange left and right, or set the \"front\", in a bone map (marey "
                   "inspect FILE --write-map writes one)");
}

void scale_side_confidence(FoundBones& found, double share) {
  for (const B bone : human_bones()) {
    auto& slot = found.bones[index(bone)];
    if (slot && mirrored(bone) != bone && slot->evidence != BoneEvidence::kUser) {
      slot->confidence *= share;
    }
  }
}

/// Returns the front, and makes the sides agree with it.
Result<glm::dvec3> find_front(const SkeletonTree& tree,
                              const BoneMap& overrides,
                              const glm::dvec3& up,
                              FoundBones& found,
                              std::vector<std::string>& remarks) {
  constexpr double kAcross = 0.5;
  if (overrides.front &&
      glm::length(glm::cross(glm::normalize(*overrides.front), up)) < kAcross) {
    return bad_input("skeleton",
                     "the bone map's \"front\" is not across the body's up, which is " +
                         axis_word(snapped(up, kNearFront)),
                     "set a direction at right angles to it, or set \"up\" as well");
  }
  const bool by_shape =
      found.bones[index(B::kLeftUpperLeg)]->evidence == BoneEvidence::kShape;
  const auto left_axis = [&] {
    const BodyPlaces p = rest_places(tree, found);
    const glm::dvec3 across = p.hip[0] - p.hip[1];
    return unit_of(across - up * glm::dot(across, up));
  };
  const glm::dvec3 toes =
      overrides.front ? unit_of(*overrides.front - up * glm::dot(*overrides.front, up))
                      : toes_direction(tree, found, up);
  const auto agreement = [&] { return glm::dot(glm::cross(left_axis(), up), toes); };
  if (by_shape) {
    const bool guess = toes == glm::dvec3(0.0);
    // In most files the body faces +Z, or -Y where Z is up.
    const glm::dvec3 usual = up.z > 0.5 ? glm::dvec3(0, -1, 0) : glm::dvec3(0, 0, 1);
    const glm::dvec3 front = glm::cross(left_axis(), up);
    if ((guess ? glm::dot(front, usual) : agreement()) < 0.0) exchange_sides(found);
    align_arms(tree, left_axis(), found);
    if (guess) {
      scale_side_confidence(found, 0.6);
      remarks.push_back("its front cannot be identified; it is assumed to face " +
                        axis_word(snapped(glm::cross(left_axis(), up), kNearFront)));
    }
  }
  const double agrees = agreement();
  if (agrees < -0.3) {
    return wrong_side(
        tree,
        found,
        B::kLeftUpperLeg,
        overrides.front ? "whose front is set in the bone map"
                        : "whose toes point to " + axis_word(snapped(toes, kNearFront)));
  }
  const auto arm = found.joint(B::kLeftUpperArm);
  const auto other = found.joint(B::kRightUpperArm);
  if (arm && other) {
    const glm::dvec3 across = tree.place(*arm) - tree.place(*other);
    if (glm::dot(across, left_axis()) < 0.0) {
      return wrong_side(tree, found, B::kLeftUpperArm, "where its right leg is");
    }
  }
  if (agrees < 0.3 && !by_shape) {
    scale_side_confidence(found, 0.85);
    remarks.push_back(
        "its feet do not show where its front is; left and right follow from the "
        "joint names");
  }
  if (overrides.front) return toes;  // Checked to lie across `up`.
  const glm::dvec3 front = snapped(glm::cross(left_axis(), up), kNearFront);
  if (snapped(front, 1.0 - 1e-9) != front) {
    remarks.push_back("at rest it faces between two axes: " + axis_word(front));
  }
  return unit_of(front - up * glm::dot(front, up));
}

double stature(const SkeletonTree& tree, const FoundBones& found) {
  double legs = 0.0;
  for (const auto& [upper, lower, foot] :
       {std::array{B::kLeftUpperLeg, B::kLeftLowerLeg, B::kLeftFoot},
        std::array{B::kRightUpperLeg, B::kRightLowerLeg, B::kRightFoot}}) {
    legs += 0.5 * (tree.distance(*found.joint(upper), *found.joint(lower)) +
                   tree.distance(*found.joint(lower), *found.joint(foot)));
  }
  const auto head = found.joint(B::kHead);
  if (!head) return legs / 0.491;
  const BodyPlaces p = rest_places(tree, found);
  JointIndex joint = *head;
  double trunk = 0.0;
  const JointIndex hips = *found.joint(B::kHips);
  while (tree.parent(joint) && *tree.parent(joint) != hips) {
    trunk += tree.distance(joint, *tree.parent(joint));
    joint = *tree.parent(joint);
  }
  trunk += glm::distance(tree.place(joint), p.mid_hip());
  return (legs + trunk) / kLegsAndTrunk;
}

std::string text(const char* format, double a, double b = 0.0) {
  std::array<char, 160> out{};
  std::snprintf(out.data(), out.size(), format, a, b);
  return out.data();
}

void find_unit(const SkeletonTree& tree,
               const FoundBones& found,
               const FileUnit& unit,
               const BoneMap& overrides,
               BodyFrame& frame) {
  const double as_read = stature(tree, found);
  const double length = as_read / unit.read_m;  // In the file's numbers.
  const double low = unit.is_stated ? 0.25 : 0.4;
  const double high = unit.is_stated ? 12.0 : 4.0;
  double unit_m = unit.read_m;
  if (overrides.unit_m) {
    unit_m = *overrides.unit_m;
  } else if (as_read > 0.0 && (as_read < low || as_read > high)) {
    const auto off = [&](double candidate) {
      return std::abs(std::log(length * candidate / kUsualStature_m));
    };
    for (const double candidate : {1.0, 0.1, 0.01, 0.001, 0.0254, 0.0254 / 0.45}) {
      if (off(candidate) < off(unit_m)) unit_m = candidate;
    }
    frame.remarks.push_back(
        text("its unit is assumed to be %.6g m, since the body would be ", unit_m) +
        text("%.3g m tall in units of %.3g m", as_read, unit.read_m));
  }
  frame.unit_m = unit_m;
  frame.scale = unit_m == unit.read_m ? 1.0 : unit_m / unit.read_m;
  frame.stature_m = as_read * frame.scale;
}

}  // namespace

std::string axis_word(const glm::dvec3& direction) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(direction[axis]) < 1.0 - 1e-9) continue;
    return {direction[axis] > 0.0 ? '+' : '-', static_cast<char>('X' + axis)};
  }
  std::array<char, 80> out{};
  std::snprintf(out.data(),
                out.size(),
                "(%.3f, %.3f, %.3f)",
                direction.x,
                direction.y,
                direction.z);
  return out.data();
}

bool stands_at_rest(const Skeleton& skeleton, const FoundBones& found) {
  return stands(rest_places(SkeletonTree(skeleton), found));
}

double asymmetry(const Skeleton& skeleton, const FoundBones& found) {
  const SkeletonTree tree(skeleton);
  const BodyPlaces p = rest_places(tree, found);
  const glm::dvec3 left = unit_of(p.hip[0] - p.hip[1]);
  const double leg = glm::distance(p.hip[0], p.foot[0]);
  double sum = 0.0;
  double count = 0.0;
  for (const B bone : human_bones()) {
    const auto joint = found.joint(bone);
    const auto other = found.joint(mirrored(bone));
    if (bone >= mirrored(bone) || !joint || !other) continue;
    const glm::dvec3 from_middle = tree.place(*other) - p.mid_hip();
    const glm::dvec3 image =
        tree.place(*other) - 2.0 * glm::dot(from_middle, left) * left;
    sum += glm::distance(tree.place(*joint), image);
    count += 1.0;
  }
  return count > 0.0 && leg > 0.0 ? sum / count / leg : 0.0;
}

Result<BodyFrame> find_body_frame(const Skeleton& skeleton,
                                  const FileUnit& unit_of_file,
                                  const BoneMap& overrides,
                                  FoundBones& found) {
  const SkeletonTree tree(skeleton);
  const BodyPlaces p = rest_places(tree, found);
  if (const Status ok = check_stands(tree, found, p); !ok) return ok.error();
  BodyFrame frame;
  const glm::dvec3 up = unit_of(p.mid_hip() - p.mid_foot());
  frame.up_in_file = overrides.up ? unit_of(*overrides.up) : snapped(up, kNearUp);
  if (glm::dot(frame.up_in_file, up) < 0.5) {
    return bad_input("skeleton",
                     "its feet are not below its hips when up is " +
                         axis_word(frame.up_in_file) + ", as set in the bone map",
                     "remove \"up\" from the bone map, or correct it");
  }
  if (snapped(frame.up_in_file, 1.0 - 1e-9) != frame.up_in_file) {
    frame.remarks.push_back("it leans at rest; its up is " + axis_word(frame.up_in_file));
  }
  const auto front = find_front(tree, overrides, frame.up_in_file, found, frame.remarks);
  if (!front) return front.error();
  frame.front_in_file = *front;
  if (frame.up_in_file != glm::dvec3(0, 1, 0) || *front != glm::dvec3(0, 0, 1)) {
    const glm::dvec3 left = glm::cross(frame.up_in_file, *front);
    const glm::dmat3 file_from_marey(left, frame.up_in_file, *front);
    frame.marey_from_file =
        glm::normalize(glm::conjugate(glm::quat_cast(file_from_marey)));
  }
  find_unit(tree, found, unit_of_file, overrides, frame);
  return frame;
}

void put_into_frame(const BodyFrame& frame, Motion& motion) {
  if (frame.is_marey()) return;
  for (Joint& joint : motion.skeleton.joints) {
    joint.parent_from_joint.translation *= frame.scale;
    if (joint.tip_in_joint) *joint.tip_in_joint *= frame.scale;
  }
  const glm::dquat& turn = frame.marey_from_file;
  RigidTransform& rest = motion.skeleton.joints[0].parent_from_joint;
  rest.rotation = glm::normalize(turn * rest.rotation);
  rest.translation = turn * rest.translation;
  for (Pose& pose : motion.poses) {
    pose.root_in_world = turn * (pose.root_in_world * frame.scale);
    pose.parent_from_joint[0] = glm::normalize(turn * pose.parent_from_joint[0]);
  }
}

}  // namespace marey::retarget
