// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "edit/filter/filter_group.h"
#include "edit/filter/held_foot.h"
#include "edit/find/find_impacts.h"
#include "edit/state/op_weights.h"
#include "edit/state/plant_feet.h"
#include "edit/state/resample_state.h"
#include <glm/geometric.hpp>

#include "core/base/degrees.h"
#include "core/pose.h"
#include "core/signal/choose_smoothing.h"
#include "retarget/contacts/frame_marks.h"
#include "retarget/feet/leg_placement.h"

namespace marey::edit {
namespace {

std::vector<EditGroup> chosen_groups(const EditOp& op) {
  if (!op.groups.empty()) return op.groups;
  return {kEditGroups.begin(), kEditGroups.end()};
}

/// Change of the places of a group's joints by the filter.
struct RemovedFigures {
  double rms_m = 0.0;
  double largest_m = 0.0;
  std::size_t frame = 0;
};

RemovedFigures removed_from(const EditState& state,
                            const Motion& after,
                            EditGroup group) {
  RemovedFigures out;
  const Skeleton& skeleton = state.motion.skeleton;
  const auto joints = joints_of_groups(state, std::array{group});
  if (joints.empty()) return out;
  const auto carrier = skeleton[joints.front()].parent;
  const auto own = [&](const std::vector<RigidTransform>& world, JointIndex joint) {
    const glm::dvec3& p = world[index(joint)].translation;
    return carrier ? inverse(world[index(*carrier)]) * p : p;
  };
  std::vector<RigidTransform> old_joints(skeleton.joints.size());
  std::vector<RigidTransform> new_joints(skeleton.joints.size());
  double squares = 0.0;
  for (std::size_t t = 0; t < after.poses.size(); ++t) {
    world_from_joints(skeleton, state.motion.poses[t], old_joints);
    world_from_joints(skeleton, after.poses[t], new_joints);
    for (const JointIndex joint : joints) {
      const double removed_m =
          glm::distance(own(old_joints, joint), own(new_joints, joint));
      squares += removed_m * removed_m;
      if (removed_m <= out.largest_m) continue;
      out.largest_m = removed_m;
      out.frame = t;
    }
  }
  const std::size_t count = joints.size() * after.poses.size();
  out.rms_m = std::sqrt(squares / static_cast<double>(count));
  return out;
}

void report_group(const EditState& state,
                  const Motion& after,
                  const FilteredGroup& found,
                  OpReport& report) {
  const std::string key(name(found.group));
  const RemovedFigures removed = removed_from(state, after, found.group);
  const auto add = [&](const char* figure, double value) {
    report.figures.emplace_back(key + figure, value);
  };
  add("_cutoff_hz", *found.cutoff_hz);
  add("_noise_deg", found.noise_rad * kDegreesPerRadian);
  if (found.group == EditGroup::kRoot) add("_noise_mm", 1e3 * found.noise_m);
  add("_removed_rms_mm", 1e3 * removed.rms_m);
  add("_removed_max_mm", 1e3 * removed.largest_m);
  add("_removed_max_s", static_cast<double>(removed.frame) / state.motion.rate.hz);
}

/// Filters all groups, and reports groups without movement.
std::array<std::vector<int>, 2> filter_groups(const FilterOp& op,
                                              const OpContext& context,
                                              const EditState& state,
                                              Motion& out,
                                              OpReport& report) {
  const std::array impacts{find_impacts(state, 0), find_impacts(state, 1)};
  std::string constant;
  for (const EditGroup group : chosen_groups(context.op)) {
    std::vector<int> own;
    if (group == EditGroup::kLeftLeg) own = impacts[0];
    if (group == EditGroup::kRightLeg) own = impacts[1];
    if (joints_of_groups(state, std::array{group}).empty()) continue;
    const FilteredGroup found = filter_group(op, state, group, own, out);
    if (found.cutoff_hz) {
      report_group(state, out, found, report);
    } else {
      constant += (constant.empty() ? "" : ", ") + std::string(name(group));
    }
  }
  report.figures.emplace_back("impacts",
                              static_cast<double>(impacts[0].size() + impacts[1].size()));
  if (constant.empty()) return impacts;
  Finding finding{Severity::kNote,
                  "constant",
                  constant,
                  "has no movement to filter; left as it is",
                  ""};
  report.findings.push_back(std::move(finding));
  return impacts;
}

/// Returns the largest displacement of bearing joints in contacts.
double feet_moved_m(const EditState& before, const EditState& after) {
  double largest = 0.0;
  const std::size_t count = before.motion.poses.size();
  for (int side = 0; side < 2; ++side) {
    const auto s = static_cast<std::size_t>(side);
    const auto& contacts = before.contacts.feet[s];
    const auto heel = retarget::frame_marks(contacts.heel, count);
    const auto ball = retarget::frame_marks(contacts.ball, count);
    const auto old = foot_places(before, side);
    const auto now = foot_places(after, side);
    const glm::dvec3& to_ball = before.map.feet[s].ball_from_ankle_in_t_pose;
    for (std::size_t t = 0; t < count; ++t) {
      const glm::dvec3 moved = now[t].ankle_in_world - old[t].ankle_in_world;
      const glm::dvec3 turned = now[t].foot * to_ball - old[t].foot * to_ball;
      if (heel[t]) largest = std::max(largest, glm::length(moved));
      if (ball[t]) largest = std::max(largest, glm::length(moved + turned));
    }
  }
  return largest;
}

void hold_filtered_feet(const EditState& before,
                        const std::array<std::vector<int>, 2>& impacts,
                        const FrameRange& frames,
                        EditState& state,
                        OpReport& report) {
  std::array<HeldFoot, 2> feet;
  for (int side = 0; side < 2; ++side) {
    const auto s = static_cast<std::size_t>(side);
    feet[s] = held_foot(foot_places(before, side),
                        foot_places(state, side),
                        state.contacts.feet[s],
                        state.map.feet[s],
                        impacts[s],
                        state.motion.rate.hz);
    for (int frame = 0; frame < state.frame_count(); ++frame) {
      if (frame >= frames.first && frame <= frames.last) continue;
      feet[s][static_cast<std::size_t>(frame)].reset();
    }
  }
  // The root sinks only where a straight leg does not reach: a lower limit would lower it
  // by the noise.
  retarget::GroundOptions ground;
  ground.straight = 1.0;
  const PlantReport planted = set_feet(state, feet, {ground});
  report.figures.emplace_back("unreachable_frames", planted.unreachable_frames);
}

}  // namespace

Status check_filter(const FilterOp& op, double rate_hz) {
  if (op.method == FilterMethod::kGcvSpline && op.order != 2 && op.order != 3) {
    return bad_input("order",
                     "is " + std::to_string(op.order),
                     "give 2 (cubic spline) or 3 (quintic spline)");
  }
  const bool given =
      op.method == FilterMethod::kButterworth && op.cutoff == CutoffRule::kGiven;
  if (given && !(op.cutoff_hz > 0.0 && op.cutoff_hz < 0.5 * rate_hz)) {
    return bad_input(
        "cutoff_hz",
        "is not between 0 and half the rate of " + std::to_string(rate_hz) + " Hz",
        "give a lower cut-off, or leave it out");
  }
  return Done{};
}

Result<EditState> apply_filter(const FilterOp& op,
                               const OpContext& context,
                               const EditState& state,
                               OpReport& report) {
  if (const Status ok = check_filter(op, state.motion.rate.hz); !ok) return ok.error();
  const auto weights = op_weights(state, context.op);
  if (!weights) return weights.error();
  if (state.motion.poses.size() < kMinSmoothingSamples) {
    report.findings.push_back(
        fair_finding(
            "too_short",
            "motion",
            "has " + std::to_string(state.frame_count()) +
                " frames, too few to separate noise from movement; left as it is",
            "filter before the cut")
            .measured(state.frame_count(),
                      static_cast<double>(kMinSmoothingSamples),
                      "frames"));
    return state;
  }
  EditState out = state;
  const auto impacts = filter_groups(op, context, state, out.motion, report);
  mix_motion(state.motion, *weights, state, context.op.groups, out.motion);
  if (op.keep_contacts) hold_filtered_feet(state, impacts, weights->frames, out, report);
  report.figures.emplace_back("feet_moved_mm", 1e3 * feet_moved_m(state, out));
  report.figures.emplace_back(
      "displaced_mm",
      1e3 * mark_displaced(out, state.motion, weights->frames, context.index));
  return out;
}

}  // namespace marey::edit
