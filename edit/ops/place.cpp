// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/place.h"

#include <cmath>
#include <vector>

#include "edit/state/check_op_keys.h"
#include "edit/state/move_state.h"
#include "edit/state/resample_state.h"
#include "edit/state/resolve_moment.h"
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "core/pose.h"
#include "retarget/body/rotation_from_t_pose.h"

namespace marey::edit {
namespace {

constexpr double kTravels_m = 0.3;

/// Returns the place and the rotation from the T-pose of the hips at a frame.
RigidTransform hips_at(const EditState& state, double frame) {
  const auto before = static_cast<std::size_t>(frame);
  const std::size_t after = std::min(before + 1, state.motion.poses.size() - 1);
  const Pose pose = between_poses(state.motion.poses[before],
                                  state.motion.poses[after],
                                  frame - static_cast<double>(before));
  const std::vector<RigidTransform> joints =
      world_from_joints(state.motion.skeleton, pose);
  const JointIndex hips = state.map.hips();
  return {retarget::rotation_from_t_pose(state.map, joints, hips),
          joints[index(hips)].translation};
}

double direction_rad(const glm::dvec3& towards) {
  return std::atan2(towards.x, towards.z);
}

}  // namespace

Result<EditState> apply_place(const PlaceOp& op,
                              const OpContext& context,
                              const EditState& state,
                              OpReport& report) {
  if (const Status ok = check_op_keys(context.op, {.span = true}); !ok) return ok.error();
  if (!op.position_xz_m && !op.heading_rad) {
    return bad_input(
        "place", "has neither a position nor a heading", "state one of them");
  }
  const auto at = resolve_moment(state, op.at);
  if (!at) return at.error();
  const auto span = resolve_span(state, context.op.span);
  if (!span) return span.error();
  const RigidTransform hips = hips_at(state, *at);
  double turn_rad = 0.0;
  if (op.heading_rad) {
    const glm::dvec3 travel =
        hips_at(state, span->last).translation - hips_at(state, span->first).translation;
    const bool travels = std::hypot(travel.x, travel.z) >= kTravels_m;
    turn_rad = *op.heading_rad -
               direction_rad(travels ? travel : hips.rotation * glm::dvec3(0, 0, 1));
  }
  glm::dvec3 target = hips.translation;
  if (op.position_xz_m) target = {op.position_xz_m->x, target.y, op.position_xz_m->y};
  EditState out = state;
  move_state(turn_about(hips.translation, turn_rad, target), out);
  touch(out.lineage, {0, out.frame_count() - 1}, context.index);
  report.figures.emplace_back("turn_deg", glm::degrees(turn_rad));
  report.figures.emplace_back("moved_m", glm::distance(hips.translation, target));
  return out;
}

}  // namespace marey::edit
