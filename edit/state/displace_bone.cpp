// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/state/displace_bone.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>

#include "edit/state/bend_limb.h"
#include "edit/state/hold_feet.h"
#include "edit/state/reach_with_body.h"
#include "edit/state/resample_state.h"
#include <glm/geometric.hpp>

#include "core/base/format_text.h"
#include "core/nearest_word.h"
#include "core/pose.h"
#include "core/transform.h"

namespace marey::edit {
namespace {

constexpr double kMaxWay_m = 100.0;
constexpr double kUnitTolerance = 1e-6;
/// A smaller distance from a target is rounding.
constexpr double kMissed_m = 1e-4;
constexpr double kBoneToMm = 1e3;

bool is_finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Returns the limb, as in human_limbs(), whose end is this bone.
std::optional<int> limb_of_end(HumanBone bone) {
  for (std::size_t limb = 0; limb < human_limbs().size(); ++limb) {
    if (human_limbs()[limb].end == bone) return static_cast<int>(limb);
  }
  return std::nullopt;
}

bool is_foot(HumanBone bone) {
  return bone == HumanBone::kLeftFoot || bone == HumanBone::kRightFoot;
}

/// Returns true for bones of a leg whose rotation moves the foot.
bool carries_foot(HumanBone bone) {
  return bone == HumanBone::kLeftUpperLeg || bone == HumanBone::kLeftLowerLeg ||
         bone == HumanBone::kRightUpperLeg || bone == HumanBone::kRightLowerLeg;
}

Status check_bone(HumanBone bone, const EditState& state) {
  if (state.map.joint_of[marey::index(bone)]) return Done{};
  std::vector<std::string_view> names;
  for (const HumanBone other : human_bones()) {
    if (state.map.joint_of[marey::index(other)]) names.push_back(name(other));
  }
  return bad_input(
      "bone", "the body has no bone " + in_quotes(bone), suggestion(name(bone), names));
}

Status check_displacement(const BoneDisplacement& wanted, const EditState& state) {
  if (!wanted.rotation && !wanted.moved_m) {
    return bad_input("", "states no displacement", "give a rotation, or moved_m");
  }
  if (const Status ok = check_bone(wanted.bone, state); !ok) return ok.error();
  if (wanted.rotation) {
    const double length = glm::length(*wanted.rotation);
    if (!(std::abs(length - 1.0) < kUnitTolerance)) {  // True for NaN.
      return bad_input(
          "rotation", "is not a unit quaternion", "give axis and angle, or normalize it");
    }
  }
  if (!wanted.moved_m) return Done{};
  if (!is_finite(*wanted.moved_m) || glm::length(*wanted.moved_m) > kMaxWay_m) {
    return bad_input("moved_m",
                     "is not finite, or longer than 100 m",
                     "give the displacement in metres");
  }
  const auto limb = limb_of_end(wanted.bone);
  if (wanted.bone == HumanBone::kHips) return Done{};
  if (!limb) {
    return bad_input("moved_m",
                     "the bone " + in_quotes(wanted.bone) + " cannot be moved to a place",
                     "use a hand, a foot or the hips, or give a rotation");
  }
  if (!state.map.limbs[static_cast<std::size_t>(*limb)]) {
    return bad_input(
        "moved_m",
        "the body has no complete limb that ends in " + in_quotes(wanted.bone),
        "give a rotation");
  }
  return Done{};
}

void add_rotation(const BoneDisplacement& wanted,
                  const OpWeights& weights,
                  EditState& state) {
  if (!wanted.rotation) return;
  const std::size_t joint = index(*state.map.joint_of[marey::index(wanted.bone)]);
  const glm::dvec3 whole_rad = rotation_vector(*wanted.rotation);
  for (int frame = weights.frames.first; frame <= weights.frames.last; ++frame) {
    const auto t = static_cast<std::size_t>(frame);
    glm::dquat& q = state.motion.poses[t].parent_from_joint[joint];
    q = glm::normalize(rotation_from_vector(weights.weight[t] * whole_rad) * q);
  }
}

struct LimbMiss {
  double missed_m = 0.0;
  int frame = 0;
};

/// Moves the end of a limb by its weights.
Result<LimbMiss> move_limb(const BoneDisplacement& wanted,
                           int limb,
                           const OpWeights& weights,
                           EditState& state) {
  const Skeleton& skeleton = state.motion.skeleton;
  const std::size_t end = index(*state.map.joint_of[marey::index(wanted.bone)]);
  std::vector<RigidTransform> joints(skeleton.joints.size());
  std::vector<glm::dvec3> path(state.motion.poses.size(), glm::dvec3(0.0));
  EditState moved = state;
  LimbBender bender(skeleton, state.map);
  LimbMiss miss;
  for (int frame = weights.frames.first; frame <= weights.frames.last; ++frame) {
    const auto t = static_cast<std::size_t>(frame);
    world_from_joints(skeleton, state.motion.poses[t], joints);
    path[t] = joints[end].translation + weights.weight[t] * *wanted.moved_m;
    std::optional<glm::dquat> world_from_end;
    if (is_foot(wanted.bone)) world_from_end = joints[end].rotation;
    const double missed_m =
        bender.move_end(limb, path[t], world_from_end, moved.motion.poses[t]);
    if (missed_m <= miss.missed_m) continue;
    miss = {missed_m, frame};
  }
  if (miss.missed_m > kMissed_m) {
    const auto reached = reach_with_body(wanted.bone, path, weights.frames, state);
    if (!reached) return reached.error();
    return LimbMiss{reached->missed_m, reached->missed_frame};
  }
  state = std::move(moved);
  return miss;
}

void move_hips(const BoneDisplacement& wanted,
               const OpWeights& weights,
               EditState& state) {
  for (int frame = weights.frames.first; frame <= weights.frames.last; ++frame) {
    const auto t = static_cast<std::size_t>(frame);
    state.motion.poses[t].root_in_world += weights.weight[t] * *wanted.moved_m;
  }
}

std::string at_time(const EditState& state, int frame) {
  return format_text("%.2f s", frame / state.motion.rate.hz);
}

/// Reports a moved foot that stands, because it slides.
void report_slide(const BoneDisplacement& wanted,
                  const OpWeights& weights,
                  const EditState& state,
                  OpReport& report) {
  if (!wanted.moved_m || !is_foot(wanted.bone)) return;
  const std::size_t side = wanted.bone == HumanBone::kLeftFoot ? 0 : 1;
  for (const FrameRange& run : state.contacts.feet[side].stance) {
    if (run.last < weights.frames.first || run.first > weights.frames.last) continue;
    report.findings.push_back(fair_finding(
        "slide",
        std::string(name(wanted.bone)),
        "the foot stands from " + at_time(state, run.first) + " to " +
            at_time(state, run.last) + ", where it is moved",
        "choose an instant in which it is in the air, or plant the feet afterwards"));
    return;
  }
}

void report_miss(const BoneDisplacement& wanted,
                 const LimbMiss& miss,
                 const EditState& state,
                 OpReport& report) {
  report.figures.emplace_back("missed_mm", kBoneToMm * miss.missed_m);
  if (miss.missed_m <= kMissed_m) return;
  report.findings.push_back(
      fair_finding("reach",
                   std::string(name(wanted.bone)),
                   "the target is out of reach by " +
                       format_text("%.0f mm", kBoneToMm * miss.missed_m) + " at " +
                       at_time(state, miss.frame),
                   "move it less far, or move the hips as well")
          .measured(kBoneToMm * miss.missed_m, std::nullopt, "mm"));
}

void keep_feet(const BoneDisplacement& wanted,
               const Motion& before,
               const FrameRange& frames,
               EditState& state,
               OpReport& report) {
  const bool is_hips = wanted.bone == HumanBone::kHips;
  if (!is_hips && !(wanted.rotation && carries_foot(wanted.bone))) return;
  const KeptFeet kept = is_hips ? keep_both_feet(state) : keep_standing_feet(state);
  const HoldFeetReport held = hold_feet(state, before, frames, kept, state.motion);
  report.figures.emplace_back("lowered_mm", kBoneToMm * held.lowered_m);
  report.figures.emplace_back("feet_missed_mm", kBoneToMm * held.missed_m);
  if (held.lowered_m > kMissed_m) {
    report.findings.push_back(
        fair_finding("reach",
                     "legs",
                     "the root was lowered by up to " +
                         format_text("%.0f mm", kBoneToMm * held.lowered_m) +
                         ", because the legs do not reach the feet's places otherwise",
                     "displace the hips less")
            .measured(kBoneToMm * held.lowered_m, std::nullopt, "mm"));
  }
  if (held.missed_m > kMissed_m) {
    report.findings.push_back(
        fair_finding("reach",
                     "legs",
                     "a foot leaves its place by " +
                         format_text("%.0f mm", kBoneToMm * held.missed_m) + " at " +
                         at_time(state, held.missed_frame),
                     "displace the hips less; \"place\" moves the whole motion")
            .measured(kBoneToMm * held.missed_m, std::nullopt, "mm"));
  }
}

}  // namespace

Status displace_bone(const BoneDisplacement& displacement,
                     const OpWeights& weights,
                     EditState& state,
                     OpReport& report) {
  if (const Status ok = check_displacement(displacement, state); !ok) return ok.error();
  const Motion before = state.motion;
  // The way of a hand or foot is measured from its place in the motion; a rotation of the
  // same bone does not move its joint.
  if (displacement.moved_m) {
    if (const auto limb = limb_of_end(displacement.bone)) {
      const auto miss = move_limb(displacement, *limb, weights, state);
      if (!miss) return miss.error();
      report_miss(displacement, *miss, state, report);
    } else {
      move_hips(displacement, weights, state);
    }
  }
  add_rotation(displacement, weights, state);
  report_slide(displacement, weights, state, report);
  keep_feet(displacement, before, weights.frames, state, report);
  const double largest_m = mark_displaced(state, before, weights.frames, report.index);
  report.figures.emplace_back("displaced_mm", kBoneToMm * largest_m);
  return Done{};
}

}  // namespace marey::edit
