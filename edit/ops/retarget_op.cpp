// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/retarget_op.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "edit/state/check_op_keys.h"
#include "edit/state/plant_feet.h"

#include "core/base/in_quotes.h"
#include "core/nearest_word.h"
#include "core/pose.h"
#include "retarget/constraints/resolve_segment.h"
#include "retarget/feet/adapt_to_ground.h"
#include "retarget/hands/touch_constraints.h"
#include "retarget/motion/retarget_motion.h"

namespace marey::edit {
namespace {

using retarget::StillPlace;
using retarget::WorldScale;

/// Transform of the world from the source's body to the avatar's, as retarget_motion()
/// uses it.
WorldScale world_scale(const RetargetOp& op,
                       const EditState& state,
                       const retarget::BodyMap& avatar) {
  constexpr auto kRoot = retarget::RootNormalization::kLegLength;
  WorldScale world{retarget::root_unit_m(avatar, kRoot) /
                   retarget::root_unit_m(state.map, kRoot)};
  const auto rest_m = retarget::ankles_rest_m(state.map, state.contacts);
  world.keeps_path = op.keep_world;
  world.rise_m = retarget::standing_rise_m(state.map, rest_m, avatar, world.scale);
  world.source_floor_m = retarget::floor_height_m(state.map, rest_m);
  return world;
}

/// Scales the goals of constraints to the avatar's world.
struct GoalScaler {
  const WorldScale& world;

  [[nodiscard]] glm::dvec3 of(const glm::dvec3& p) const {
    return world.of(p, StillPlace::kScaled);
  }
  void operator()(DistanceToPoint& goal) const {
    goal.distance_m *= world.scale;
    goal.p_in_world = of(goal.p_in_world);
  }
  void operator()(DistanceToBody& goal) const {
    goal.distance_m *= world.scale;
    goal.other.offset_in_t_pose *= world.scale;
  }
  void operator()(DistanceToConstraint& goal) const { goal.distance_m *= world.scale; }
  void operator()(AllowedSpace& goal) const {
    goal.min_in_world = of(goal.min_in_world);
    goal.max_in_world = of(goal.max_in_world);
  }
  void operator()(ForbiddenSpace& goal) const {
    goal.min_in_world = of(goal.min_in_world);
    goal.max_in_world = of(goal.max_in_world);
  }
  void operator()(SegmentOrientation& /*goal*/) const {}
  void operator()(Support& goal) const {
    if (goal.footprint_in_world) goal.footprint_in_world = of(*goal.footprint_in_world);
  }
};

/// Returns the frame in the middle of a constraint's time.
std::size_t middle_frame(const Constraint& constraint, const EditState& state) {
  const Activation& when = constraint.activation;
  const double from_s = when.start_s ? *when.start_s + when.start_duration_s : 0.0;
  const double to_s = when.stop_s.value_or(state.duration_s());
  const double frame = std::round(0.5 * (from_s + to_s) * state.motion.rate.hz);
  return static_cast<std::size_t>(
      std::clamp(frame, 0.0, static_cast<double>(state.frame_count() - 1)));
}

/// Sets footprint and rotation of a support to the avatar's own at that time.
void take_footprint(const EditState& avatar, Constraint& constraint) {
  auto& support = std::get<Support>(constraint.goal);
  const auto joint =
      *retarget::resolve_segment(avatar.motion.skeleton, constraint.point.segment);
  const auto joints = world_from_joints(
      avatar.motion.skeleton, avatar.motion.poses[middle_frame(constraint, avatar)]);
  const RigidTransform& foot = joints[index(joint)];
  const glm::dquat t_pose_from_joint = avatar.map.joints[index(joint)].t_pose_from_joint;
  const glm::dquat world_from_t_pose =
      glm::normalize(foot.rotation * glm::conjugate(t_pose_from_joint));
  if (support.footprint_in_world) {
    support.footprint_in_world =
        foot.translation + world_from_t_pose * constraint.point.offset_in_t_pose;
  }
  if (support.world_from_t_pose) support.world_from_t_pose = world_from_t_pose;
}

bool has_segments(const Constraint& constraint, const Skeleton& skeleton) {
  if (!retarget::resolve_segment(skeleton, constraint.point.segment)) return false;
  const auto* body = std::get_if<DistanceToBody>(&constraint.goal);
  return body == nullptr ||
         retarget::resolve_segment(skeleton, body->other.segment).has_value();
}

/// Scales the constraints of `out`, whose motion is the avatar's. Returns the number of
/// dropped ones.
int scale_constraints(const WorldScale& world, EditState& out, OpReport& report) {
  std::vector<Constraint>& all = out.constraints.constraints;
  std::vector<std::string> dropped;
  std::erase_if(all, [&](const Constraint& constraint) {
    const auto* other = std::get_if<DistanceToConstraint>(&constraint.goal);
    const bool is_gone =
        !has_segments(constraint, out.motion.skeleton) ||
        (other != nullptr &&
         std::find(dropped.begin(), dropped.end(), other->other_id) != dropped.end());
    if (is_gone) dropped.push_back(constraint.id);
    return is_gone;
  });
  for (const std::string& id : dropped) {
    report.findings.push_back(fair_finding("dropped",
                                           "constraint " + in_quotes(id),
                                           "the avatar does not have its segment",
                                           "constrain the avatar after this operation"));
  }
  for (Constraint& constraint : all) {
    constraint.point.offset_in_t_pose *= world.scale;
    std::visit(GoalScaler{world}, constraint.goal);
    if (std::holds_alternative<Support>(constraint.goal)) take_footprint(out, constraint);
  }
  return static_cast<int>(dropped.size());
}

std::vector<std::vector<JointUncertainty>> scaled_uncertainty(
    const EditState& state,
    const retarget::BodyMap& map,
    const Skeleton& skeleton,
    double scale) {
  std::vector<std::size_t> from(skeleton.joints.size(), index(state.map.hips()));
  for (std::size_t j = 0; j < from.size(); ++j) {
    const Joint& joint = skeleton.joints[j];
    if (joint.parent) from[j] = from[index(*joint.parent)];
    if (!joint.bone ||
        map.joint_of[marey::index(*joint.bone)] != JointIndex{static_cast<int>(j)}) {
      continue;
    }
    const auto same = state.map.joint_of[marey::index(*joint.bone)];
    if (same) from[j] = index(*same);
  }
  std::vector<std::vector<JointUncertainty>> out;
  for (const auto& frame : state.uncertainty) {
    std::vector<JointUncertainty>& row = out.emplace_back();
    for (const std::size_t joint : from) {
      row.push_back(frame[joint]);
      row.back().sigma_m *= scale;
    }
  }
  return out;
}

void set_contact_heights(const retarget::BodyMap& map, Contacts& contacts) {
  for (std::size_t side = 0; side < 2; ++side) {
    contacts.feet[side].ankle_height_m = map.feet[side].ankle_height_m;
    contacts.feet[side].ball_height_m = map.feet[side].ball_height_m;
  }
}

Result<const Skeleton*> avatar_of(const RetargetOp& op, const OpContext& context) {
  const auto found = context.inputs.avatars.find(op.avatar);
  if (found != context.inputs.avatars.end()) return &found->second;
  std::vector<std::string_view> names;
  for (const auto& [path, skeleton] : context.inputs.avatars) names.push_back(path);
  return bad_input(
      "avatar",
      "the avatar " + in_quotes(op.avatar) + " was not read",
      names.empty() ? "give the path of its file" : suggestion(op.avatar, names));
}

}  // namespace

Result<EditState> apply_retarget(const RetargetOp& op,
                                 const OpContext& context,
                                 const EditState& state,
                                 OpReport& report) {
  if (const Status ok = check_op_keys(context.op, {}); !ok) return ok.error();
  const auto avatar = avatar_of(op, context);
  if (!avatar) return avatar.error();
  retarget::RetargetOptions options;
  options.hands.emplace();
  // A new detection would not have the edges that were moved by hand.
  options.known_contacts = state.contacts;
  if (op.keep_world) options.path = retarget::WorldLengths::kKept;
  auto retargeted = retarget::retarget_motion(state.motion, **avatar, options);
  if (!retargeted) return retargeted.error();
  auto map = retarget::map_body(**avatar);
  if (!map) return map.error();

  const WorldScale world = world_scale(op, state, *map);
  EditState out;
  out.motion = std::move(retargeted->motion);
  out.map = *std::move(map);
  out.uncertainty = scaled_uncertainty(state, out.map, out.motion.skeleton, world.scale);
  out.annotations = state.annotations;
  out.contacts = state.contacts;
  set_contact_heights(out.map, out.contacts);
  out.contact_edits = state.contact_edits;
  out.lineage = state.lineage;
  touch(out.lineage, {0, out.frame_count() - 1}, context.index);
  out.constraints = state.constraints;
  const int dropped = scale_constraints(world, out, report);
  report.figures.emplace_back("scale", world.scale);
  report.figures.emplace_back("slide_mm", measure_slide(out).worst_drift_mm);
  report.figures.emplace_back("constraints",
                              static_cast<double>(out.constraints.constraints.size()));
  report.figures.emplace_back("dropped_constraints", dropped);
  report.figures.emplace_back("unreachable_frames",
                              retargeted->report.ground.unreachable_frames);
  return out;
}

}  // namespace marey::edit
