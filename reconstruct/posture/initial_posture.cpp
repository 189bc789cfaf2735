// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/posture/initial_posture.h"

#include <cmath>
#include <optional>

#include <glm/geometric.hpp>

namespace marey::reconstruct {
namespace {

using Found = FoundSegments;
using B = HumanBone;

const std::optional<RigidTransform>& find(const Found& found, HumanBone bone) {
  return found[index(bone)];
}

/// Returns the child's rotation after its parent has turned rigidly from `old_parent` to
/// `new_parent`.
glm::dquat carried(const glm::dquat& old_parent,
                   const glm::dquat& old_child,
                   const glm::dquat& new_parent) {
  return glm::normalize(new_parent * glm::conjugate(old_parent) * old_child);
}

double signed_angle(const glm::dquat& rotation, const glm::dvec3& axis) {
  return glm::dot(rotation_vector(twist_about(rotation, axis)), axis);
}

/// Computes flexion and twist of the upper bone from the lower bone's rotation in the
/// upper's. The limb's plane contains its bones; a limb too straight to define a plane
/// keeps its twist.
void set_bend(const glm::dquat& upper_from_lower,
              const glm::dvec3& along,
              const glm::dvec3& hinge,
              double& flexion,
              double& upper_twist) {
  constexpr double kSpansAPlane = 0.15;  // [rad]
  const glm::dvec3 lower = upper_from_lower * along;
  const glm::dvec3 normal = glm::cross(along, lower);
  const double sine = glm::length(normal);
  const double angle = std::atan2(sine, glm::dot(along, lower));
  if (angle < kSpansAPlane) {
    const glm::dvec3 turned = rotation_from_vector(-upper_twist * along) * hinge;
    flexion = signed_angle(upper_from_lower, glm::normalize(turned));
    return;
  }
  const glm::dvec3 plane_hinge = normal / sine;
  upper_twist = -std::atan2(glm::dot(glm::cross(hinge, plane_hinge), along),
                            glm::dot(hinge, plane_hinge));
  flexion = angle;
  if (std::abs(upper_twist) > glm::radians(100.0)) {
    // A small flexion in the wrong direction is preferred to a twist by half a turn.
    upper_twist += upper_twist > 0.0 ? -glm::radians(180.0) : glm::radians(180.0);
    flexion = -angle;
  }
}

struct LimbInput {
  std::size_t limb;
  PoseParameter parent;
};

void set_limb(const LimbInput& input,
              const Found& found,
              const Lengths& lengths,
              const HingeShape& shape,
              const Posture& fallback,
              Posture& posture) {
  const LimbParameters& s = kLimbParameters[input.limb];
  const HumanLimb& bones = human_limbs()[input.limb];
  const glm::dvec3 along = limb_axis(input.limb);
  const glm::dvec3 hinge = bones.hinge_axis;
  const auto upper = find(found, bones.upper);
  const auto lower = find(found, bones.lower);
  double& flexion = *posture.block(s.flexion);
  double& upper_twist = *posture.block(s.upper_twist);
  double& lower_twist = *posture.block(s.lower_twist);
  const double l1 = lengths[index(s.upper)];
  const double l2 = lengths[index(s.lower)];
  const auto lean = [&] {
    return std::atan2(l2 * std::sin(flexion), l1 + l2 * std::cos(flexion));
  };
  const glm::dquat at_hinge =
      rotation_from_vector(shape.upper_rad * tilt_axis(input.limb));
  const glm::dquat past_hinge =
      rotation_from_vector(shape.lower_rad * tilt_axis(input.limb));
  glm::dquat frame;
  if (upper && lower) {
    // Assumes a straight hinge; exact if neither bone is twisted.
    const glm::dquat bend = glm::conjugate(at_hinge) * glm::conjugate(upper->rotation) *
                            lower->rotation * glm::conjugate(past_hinge);
    set_bend(bend, along, hinge, flexion, upper_twist);
    const glm::dquat plane = upper->rotation * rotation_from_vector(-upper_twist * along);
    frame = plane * rotation_from_vector(lean() * hinge);
    const glm::dquat untwisted =
        plane * at_hinge * rotation_from_vector(flexion * hinge) * past_hinge;
    lower_twist = signed_angle(glm::conjugate(untwisted) * lower->rotation, along);
  } else if (upper) {
    frame = upper->rotation * rotation_from_vector(-upper_twist * along) *
            rotation_from_vector(lean() * hinge);
  } else if (lower) {
    frame = lower->rotation * rotation_from_vector(-lower_twist * along) *
            glm::conjugate(past_hinge) * rotation_from_vector(-flexion * hinge) *
            glm::conjugate(at_hinge) * rotation_from_vector(lean() * hinge);
  } else {
    frame = carried(fallback.rotation(input.parent),
                    fallback.rotation(s.frame),
                    posture.rotation(input.parent));
  }
  posture.set_rotation(s.frame, glm::normalize(frame));
  const auto end = find(found, bones.end);
  posture.set_rotation(s.extremity,
                       end ? end->rotation
                           : carried(fallback.rotation(s.frame),
                                     fallback.rotation(s.extremity),
                                     posture.rotation(s.frame)));
}

void set_trunk(const Found& found, const Posture& fallback, Posture& posture) {
  const auto rotation_or = [&](B bone, PoseParameter parameter, PoseParameter parent) {
    const auto seen = find(found, bone);
    return seen ? seen->rotation
                : carried(fallback.rotation(parent),
                          fallback.rotation(parameter),
                          posture.rotation(parent));
  };
  posture.set_rotation(
      PoseParameter::kThorax,
      rotation_or(B::kUpperChest, PoseParameter::kThorax, PoseParameter::kHips));
  const auto half = [](const glm::dquat& a, const glm::dquat& b) {
    return glm::normalize(glm::slerp(a, b, 0.5));
  };
  const auto chest = find(found, B::kChest);
  posture.set_rotation(PoseParameter::kAbdomenEnd,
                       chest ? chest->rotation
                             : half(posture.rotation(PoseParameter::kHips),
                                    posture.rotation(PoseParameter::kThorax)));
  posture.set_rotation(
      PoseParameter::kHead,
      rotation_or(B::kHead, PoseParameter::kHead, PoseParameter::kThorax));
  const auto neck = find(found, B::kNeck);
  posture.set_rotation(PoseParameter::kNeck,
                       neck ? neck->rotation
                            : half(posture.rotation(PoseParameter::kThorax),
                                   posture.rotation(PoseParameter::kHead)));
}

void set_shoulder(bool left,
                  const Found& found,
                  const Lengths& lengths,
                  const BodyConstants& body,
                  const Posture& fallback,
                  Posture& posture) {
  const PoseParameter parameter =
      left ? PoseParameter::kLeftShoulder : PoseParameter::kRightShoulder;
  const B bone = left ? B::kLeftShoulder : B::kRightShoulder;
  const auto arm = find(found, left ? B::kLeftUpperArm : B::kRightUpperArm);
  posture.set_rotation(parameter,
                       carried(fallback.rotation(PoseParameter::kThorax),
                               fallback.rotation(parameter),
                               posture.rotation(PoseParameter::kThorax)));
  if (!arm || !find(found, B::kUpperChest)) return;
  const glm::dvec3 base = world_from_bone(bone, posture, lengths, body).translation;
  const glm::dvec3 wanted = arm->translation - base;
  const glm::dvec3 straight =
      posture.rotation(PoseParameter::kThorax) * glm::dvec3(left ? 1.0 : -1.0, 0.0, 0.0);
  if (glm::length(wanted) < 0.03 || glm::dot(wanted, straight) <= 0.0) return;
  posture.set_rotation(
      parameter,
      rotation_between(straight, wanted) * posture.rotation(PoseParameter::kThorax));
}

}  // namespace

Posture posture_from_segments(const Found& found,
                              const Lengths& lengths,
                              const BodyConstants& body,
                              const Posture& fallback) {
  Posture posture = fallback;
  const auto hips = find(found, B::kHips);
  if (hips) {
    posture.set_rotation(PoseParameter::kHips, hips->rotation);
    double* p = posture.block(PoseParameter::kHipsPosition);
    for (int i = 0; i < 3; ++i) p[i] = hips->translation[i];
  }
  set_trunk(found, fallback, posture);
  set_shoulder(true, found, lengths, body, fallback, posture);
  set_shoulder(false, found, lengths, body, fallback, posture);
  set_limb(
      {0, PoseParameter::kThorax}, found, lengths, body.hinges[0], fallback, posture);
  set_limb(
      {1, PoseParameter::kThorax}, found, lengths, body.hinges[1], fallback, posture);
  set_limb({2, PoseParameter::kHips}, found, lengths, body.hinges[2], fallback, posture);
  set_limb({3, PoseParameter::kHips}, found, lengths, body.hinges[3], fallback, posture);
  return posture;
}

Posture posture_from_segments(
    const std::map<HumanBone, RigidTransform>& world_from_segment,
    const Lengths& lengths,
    const BodyConstants& body,
    const Posture& fallback) {
  FoundSegments found;
  for (const auto& [bone, frame] : world_from_segment) found[index(bone)] = frame;
  return posture_from_segments(found, lengths, body, fallback);
}

Posture extrapolate(const Posture& before, const Posture& now, double share) {
  Posture next = now;
  for (const PoseParameter parameter : kAllPoseParameters) {
    if (is_rotation(parameter)) {
      const glm::dvec3 step = rotation_vector(now.rotation(parameter) *
                                              glm::conjugate(before.rotation(parameter)));
      next.set_rotation(
          parameter,
          glm::normalize(rotation_from_vector(share * step) * now.rotation(parameter)));
    } else {
      for (int i = 0; i < block_size(parameter); ++i) {
        next.block(parameter)[i] +=
            share * (now.block(parameter)[i] - before.block(parameter)[i]);
      }
    }
  }
  return next;
}

}  // namespace marey::reconstruct
