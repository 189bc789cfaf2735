// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/body/place_spine.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "retarget/body/rotation_from_t_pose.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

constexpr std::size_t kMaxBones = 2 * kMaxVertebrae + 1;
constexpr int kMaxSteps = 4;
// Minimum number of vertebrae that reach the target with the last one held.
constexpr std::size_t kEnoughVertebrae = 3;
// Share of the run's length that may remain before the last vertebra turns, too.
constexpr double kTolerance_m = 0.002;
// Share of the run's length below which the target is reached.
constexpr double kConverged = 1e-7;
// Resistance of a bone to rotation, relative to moving the end by the run's length.
// Small, so that the end comes within a millimetre of its target. Large enough that a
// nearly straight run, which hardly any rotation can shorten, does not buckle at once (at
// most three times as fast as the source bends; at a tenth of this value, thirty times).
constexpr double kStiffness = 1e-3;

/// Rigid bones joined end to end: arc length at the end of each (the last: 1), its vector
/// in the T-pose [m], and its rotation from there in the world.
struct BoneRun {
  std::size_t count = 0;
  std::array<double, kMaxBones> ends_at{};
  std::array<glm::dvec3, kMaxBones> bone{};
  std::array<glm::dquat, kMaxBones> turn{};

  void add(double end, const glm::dvec3& bone_in_t_pose, const glm::dquat& world_turn) {
    ends_at[count] = end;
    bone[count] = bone_in_t_pose;
    turn[count] = world_turn;
    ++count;
  }
};

/// The rotation of a posture's own rigid bones along its run.
struct TurnsAlong {
  std::size_t count = 0;
  std::array<double, kMaxBones> until{};
  std::array<glm::dquat, kMaxBones> turn{};

  void add(double end, const glm::dquat& world_turn) {
    until[count] = end;
    turn[count] = world_turn;
    ++count;
  }
  void add(double from, double to, const RotationCurve& curve) {
    for (std::size_t k = 1; k < static_cast<std::size_t>(curve.count); ++k) {
      add(from + (to - from) * curve.at[k], curve.rotation[k]);
    }
  }
};

TurnsAlong turns_along_spine(const NormalizedPose& pose) {
  TurnsAlong own;
  own.add(pose.spine->abdomen, pose.abdomen.rotation[0]);
  // A source without an abdomen has no bone there, only a curve.
  if (pose.spine->torso > pose.spine->abdomen) {
    own.add(pose.spine->abdomen, pose.spine->torso, pose.abdomen);
  }
  own.add(pose.spine->torso, 1.0, pose.torso);
  return own;
}

// Returns the vector from the run's end to the end it would have if every piece of its
// bones were turned as the posture's bone at the same arc length. [m]
glm::dvec3 missing_m(const BoneRun& run, const TurnsAlong& own) {
  glm::dvec3 missing(0.0);
  std::size_t k = 0;
  double at = 0.0;
  for (std::size_t i = 0; i < run.count; ++i) {
    const double begin = at;
    const double length = run.ends_at[i] - begin;
    if (length <= 0.0) continue;
    const bool last = i + 1 == run.count;
    glm::dvec3 bone(0.0);
    while (k + 1 < own.count && (last || own.until[k] < run.ends_at[i])) {
      const double until = std::max(own.until[k], at);
      bone += own.turn[k] * run.bone[i] * ((until - at) / length);
      at = until;
      ++k;
    }
    bone += own.turn[k] * run.bone[i] * ((run.ends_at[i] - at) / length);
    at = run.ends_at[i];
    missing += bone - run.turn[i] * run.bone[i];
  }
  return missing;
}

/// The bones of a run that may turn, and the resistance of the last one if it is among
/// them: the radius of the points that it carries [m].
struct Freedom {
  std::size_t first = 0;
  std::size_t end = 0;
  double carried_radius_m = 0.0;
};

/// Moves the end of a run by steps of Newton's method on |missing|^2 + (displacement of
/// the points that the last bone carries by its rotation)^2. Each bone's step is
/// perpendicular to it and to the solution of the 3 x 3 system, the residual force at the
/// end. Returns the remaining distance. [m]
glm::dvec3 move_end(BoneRun& run,
                    const Freedom& free,
                    double length_m,
                    glm::dvec3 missing) {
  const std::size_t last = run.count - 1;
  const double radius = free.carried_radius_m / length_m;
  std::array<glm::dvec3, kMaxBones> bone;
  for (std::size_t i = free.first; i < free.end; ++i) {
    bone[i] = run.turn[i] * run.bone[i] / length_m;
  }
  missing /= length_m;
  glm::dvec3 carried_turn(0.0);
  for (int step = 0; step < kMaxSteps; ++step) {
    if (glm::dot(missing, missing) < kConverged * kConverged) break;
    std::array<double, kMaxBones> gives;
    glm::dmat3 system(1.0);
    glm::dvec3 back(0.0);
    for (std::size_t i = free.first; i < free.end; ++i) {
      const double held_back = i == last ? radius * radius : 0.0;
      const double stretched = std::max(glm::dot(missing, bone[i]), 0.0);
      gives[i] = 1.0 / (kStiffness + held_back + stretched);
      system += gives[i] * (glm::dmat3(glm::dot(bone[i], bone[i])) -
                            glm::outerProduct(bone[i], bone[i]));
      if (i == last) back = -held_back * gives[i] * carried_turn;
    }
    glm::dvec3 wanted = missing;
    if (free.end > last) wanted -= glm::cross(back, bone[last]);
    const glm::dvec3 force = glm::inverse(system) * wanted;
    for (std::size_t i = free.first; i < free.end; ++i) {
      glm::dvec3 turn = gives[i] * glm::cross(bone[i], force);
      if (i == last) {
        turn += back;
        carried_turn += turn;
      }
      const glm::dvec3 half = 0.5 * turn;
      const glm::dquat by(1.0, half.x, half.y, half.z);
      run.turn[i] = glm::normalize(by * run.turn[i]);
      const glm::dvec3 now = run.turn[i] * run.bone[i] / length_m;
      missing += bone[i] - now;
      bone[i] = now;
    }
  }
  return length_m * missing;
}

// Moves the end to its target with the last vertebra held, if the others suffice.
// Otherwise all vertebrae turn; the larger the remaining distance, the more exactly.
void reach_target(BoneRun& run, const SpineLine& line, glm::dvec3 missing) {
  const std::size_t vertebrae = run.count - 1;
  if (vertebrae >= kEnoughVertebrae) {
    missing = move_end(run, {1, vertebrae, 0.0}, line.length_m, missing);
    const double near_m = kTolerance_m * line.length_m;
    const double left = glm::dot(missing, missing);
    if (left <= near_m * near_m) return;
    missing *= 1.0 - near_m * near_m / left;
  }
  run.bone[run.count - 1] = line.girdle_in_t_pose;
  move_end(run, {1, run.count, line.girdle_radius_m}, line.length_m, missing);
}

void add_section(const SpineSection& section,
                 const RotationCurve& curve,
                 double from,
                 double to,
                 BoneRun& run) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(section.count); ++i) {
    run.add(from + (to - from) * section.at[i],
            section.bone_in_t_pose[i],
            sample(curve, section.at[i]));
  }
}

BoneRun begin_at_hips(const NormalizedPose& pose, const SpineLine& line) {
  BoneRun run;
  run.add(line.shares.abdomen, line.hips_bone_in_t_pose, pose.abdomen.rotation[0]);
  return run;
}

void turn_joints(const BodyMap& map,
                 const SpineSection& section,
                 const BoneRun& run,
                 std::size_t first,
                 std::span<RigidTransform> world_from_joint) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(section.count); ++i) {
    const std::size_t joint = index(section.joints[i]);
    world_from_joint[joint].rotation =
        run.turn[first + i] * map.joints[joint].t_pose_from_joint;
  }
}

}  // namespace

void place_spine(const NormalizedPose& pose,
                 const BodyMap& map,
                 std::span<RigidTransform> world_from_joint) {
  if (map.torso.count == 0) return;
  const SpineLine line = map.spine.value_or(SpineLine{});
  BoneRun run = begin_at_hips(pose, line);
  add_section(map.abdomen, pose.abdomen, line.shares.abdomen, line.shares.torso, run);
  add_section(map.torso, pose.torso, line.shares.torso, 1.0, run);
  if (pose.spine && map.spine) {
    const glm::dvec3 missing = missing_m(run, turns_along_spine(pose));
    reach_target(run, line, missing);
  }
  turn_joints(map, map.abdomen, run, 1, world_from_joint);
  turn_joints(map,
              map.torso,
              run,
              1 + static_cast<std::size_t>(map.abdomen.count),
              world_from_joint);
}

std::array<glm::dvec3, 2> shoulders_missing_m(
    const NormalizedPose& pose,
    const Skeleton& body,
    const BodyMap& map,
    std::span<const RigidTransform> world_from_joint) {
  std::array<glm::dvec3, 2> missing{glm::dvec3(0.0), glm::dvec3(0.0)};
  if (!pose.spine || !map.spine || map.torso.count == 0) return missing;
  BoneRun run = begin_at_hips(pose, *map.spine);
  const auto add = [&](const SpineSection& section, double from, double to) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(section.count); ++i) {
      run.add(from + (to - from) * section.at[i],
              section.bone_in_t_pose[i],
              rotation_from_t_pose(map, world_from_joint, section.joints[i]));
    }
  };
  add(map.abdomen, map.spine->shares.abdomen, map.spine->shares.torso);
  add(map.torso, map.spine->shares.torso, 1.0);
  const glm::dvec3 end_missing = missing_m(run, turns_along_spine(pose));
  const std::size_t top = run.count - 1;
  const JointIndex last = map.torso.joints[static_cast<std::size_t>(map.torso.count - 1)];
  const glm::dvec3 end_from_last = run.turn[top] * run.bone[top];
  const glm::dquat still_to_turn =
      sample(pose.torso, 1.0) * glm::conjugate(run.turn[top]);
  for (std::size_t side = 0; side < 2; ++side) {
    if (!map.limbs[side]) continue;
    // The last vertebra's rotation applies up to the collar bone, which has its own.
    const B collar = side == 0 ? B::kLeftShoulder : B::kRightShoulder;
    const auto own_turn = map.joint_of[index(collar)];
    const JointIndex carried =
        own_turn && pose.segments[index(collar)] ? *own_turn : map.limbs[side]->upper;
    auto above = body[carried].parent;
    while (above && above != last) above = body[*above].parent;
    if (!above) continue;
    const glm::dvec3 from_end = world_from_joint[index(carried)].translation -
                                world_from_joint[index(last)].translation - end_from_last;
    missing[side] = end_missing + still_to_turn * from_end - from_end;
  }
  return missing;
}

void place_neck(const NormalizedPose& pose,
                const BodyMap& map,
                std::span<RigidTransform> world_from_joint) {
  // One joint in both: the segment's own orientation is sufficient.
  if (pose.neck.count == 0 || map.neck.count == 0) return;
  if (pose.neck.count == 2 && map.neck.count == 1) return;
  BoneRun run;
  add_section(map.neck, pose.neck, 0.0, 1.0, run);
  TurnsAlong own;
  own.add(0.0, 1.0, pose.neck);
  double length_m = 0.0;
  for (std::size_t i = 0; i < run.count; ++i) length_m += glm::length(run.bone[i]);
  if (length_m > 0.0) {
    move_end(run, {0, run.count, 0.0}, length_m, missing_m(run, own));
  }
  turn_joints(map, map.neck, run, 0, world_from_joint);
}

}  // namespace marey::retarget
