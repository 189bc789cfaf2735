// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/state/adapt_state.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "edit/state/plant_feet.h"
#include "edit/state/resample_state.h"
#include "edit/state/support_tracks.h"
#include <glm/geometric.hpp>

#include "core/base/format_text.h"
#include "core/base/in_quotes.h"
#include "core/pose.h"
#include "retarget/adapt/adapt_motion.h"
#include "retarget/adapt/plan_supports.h"
#include "retarget/character/make_character.h"
#include "retarget/constraints/activation.h"
#include "retarget/constraints/check_constraints.h"
#include "retarget/constraints/resolve_segment.h"
#include "retarget/feet/adapt_to_ground.h"

namespace marey::edit {
namespace {

/// The adapter's single precision, for a body some metres from the origin. [m]
constexpr double kAdapterNoise_m = 2e-5;
constexpr double kToMm = 1e3;
constexpr double kToDeg = 180.0 / std::numbers::pi;

/// Returns the feet without a support among the constraints.
std::array<bool, 2> feet_without_support(const EditState& state) {
  std::array<bool, 2> free{true, true};
  for (const Constraint& constraint : state.constraints.constraints) {
    if (!std::holds_alternative<Support>(constraint.goal)) continue;
    const auto joint =
        retarget::resolve_segment(state.motion.skeleton, constraint.point.segment);
    for (int side = 0; side < 2; ++side) {
      if (joint == state.map.leg(side).end) free[static_cast<std::size_t>(side)] = false;
    }
  }
  return free;
}

std::vector<retarget::SupportTrack> planned_supports(const EditState& state) {
  retarget::PlanSupportsOptions options;
  options.floor_height_m =
      -retarget::standing_rise_m(state.map, state.contacts, state.map, 1.0);
  options.feet = feet_without_support(state);
  return retarget::plan_supports(state.motion, state.map, state.contacts, options);
}

bool acts_at(const ConstraintSet& set, double time_s) {
  return std::any_of(
      set.constraints.begin(), set.constraints.end(), [time_s](const Constraint& c) {
        return retarget::activation(c.activation, time_s) > 0.0;
      });
}

double largest_way_m(const Skeleton& skeleton,
                     const Pose& a,
                     const Pose& b,
                     std::vector<RigidTransform>& a_joints,
                     std::vector<RigidTransform>& b_joints) {
  world_from_joints(skeleton, a, a_joints);
  world_from_joints(skeleton, b, b_joints);
  double largest_m = 0.0;
  for (std::size_t j = 0; j < a_joints.size(); ++j) {
    largest_m = std::max(largest_m,
                         glm::distance(a_joints[j].translation, b_joints[j].translation));
  }
  return largest_m;
}

/// Takes the adapted poses, except where only the adapter's rounding changed them.
void take_adapted(std::vector<Pose> adapted, EditState& state) {
  const Skeleton& skeleton = state.motion.skeleton;
  std::vector<RigidTransform> old_joints(skeleton.joints.size());
  std::vector<RigidTransform> new_joints(skeleton.joints.size());
  for (int frame = 0; frame < state.frame_count(); ++frame) {
    const auto t = static_cast<std::size_t>(frame);
    const double way_m = largest_way_m(
        skeleton, state.motion.poses[t], adapted[t], old_joints, new_joints);
    if (way_m < kAdapterNoise_m &&
        !acts_at(state.constraints, frame / state.motion.rate.hz)) {
      continue;
    }
    state.motion.poses[t] = std::move(adapted[t]);
  }
}

/// Returns the range of the frames that differ.
FrameRange changed_frames(const Motion& before, const Motion& after) {
  FrameRange changed{0, -1};
  for (int frame = 0; frame < static_cast<int>(after.poses.size()); ++frame) {
    const Pose& was = before.poses[static_cast<std::size_t>(frame)];
    const Pose& is = after.poses[static_cast<std::size_t>(frame)];
    if (was.root_in_world == is.root_in_world &&
        was.parent_from_joint == is.parent_from_joint) {
      continue;
    }
    if (changed.last < changed.first) changed.first = frame;
    changed.last = frame;
  }
  return changed;
}

void report_constraint(const retarget::KeptConstraint& kept,
                       double rate_hz,
                       OpReport& report) {
  const std::string where = "constraint " + in_quotes(kept.id);
  if (!kept.worst_frame) {
    report.findings.push_back(
        fair_finding("inactive",
                     where,
                     "it is never fully active within the motion",
                     "correct its times, which are since the first frame"));
    return;
  }
  const double error =
      kept.is_orientation ? kToDeg * kept.worst_error_rad : kToMm * kept.worst_error_m;
  report.figures.emplace_back(
      (kept.is_orientation ? "error_deg." : "error_mm.") + kept.id, error);
  if (kept.met_frames == kept.active_frames) return;
  const char* unit = kept.is_orientation ? "deg" : "mm";
  report.findings.push_back(
      fair_finding(
          "constraint",
          where,
          format_text("its error is %.1f %s at %.2f s, and it is met in %d of %d frames",
                      error,
                      unit,
                      *kept.worst_frame / rate_hz,
                      kept.met_frames,
                      kept.active_frames),
          "move its target within reach, or lower the importance of constraints that "
          "compete with it")
          .measured(error, std::nullopt, unit));
}

/// Reports the constraints and the first `own_supports` supports; reports a planned
/// support only if it is not met.
void report_adapted(const retarget::AdaptedMotion& adapted,
                    std::size_t own_supports,
                    double rate_hz,
                    OpReport& report) {
  int unmet = 0;
  double worst_m = 0.0;
  for (const auto* list : {&adapted.constraints, &adapted.supports}) {
    for (const retarget::KeptConstraint& kept : *list) {
      if (kept.met_frames < kept.active_frames) ++unmet;
      worst_m = std::max(worst_m, kept.worst_error_m);
    }
  }
  report.figures.emplace_back(
      "constraints", static_cast<double>(adapted.constraints.size() + own_supports));
  report.figures.emplace_back("unmet", unmet);
  report.figures.emplace_back("worst_constraint_mm", kToMm * worst_m);
  report.figures.emplace_back("added_acceleration_m_per_s2", adapted.added.m_per_s2);
  for (const retarget::KeptConstraint& kept : adapted.constraints) {
    report_constraint(kept, rate_hz, report);
  }
  for (std::size_t i = 0; i < adapted.supports.size(); ++i) {
    const retarget::KeptConstraint& kept = adapted.supports[i];
    if (i < own_supports || kept.met_frames < kept.active_frames) {
      report_constraint(kept, rate_hz, report);
    }
  }
}

}  // namespace

Result<Character> character_of(const EditState& state) {
  return retarget::make_character("body", state.motion.skeleton, state.map);
}

Status adapt_state(EditState& state, OpReport& report) {
  if (state.constraints.constraints.empty()) return Done{};
  const auto character = character_of(state);
  if (!character) return character.error();
  if (const Status ok = retarget::check_constraints(state.constraints, *character); !ok) {
    return ok.error();
  }
  const Motion before = state.motion;
  plant_feet(state);
  SplitConstraints split = split_supports(state, *character);
  const std::size_t own_supports = split.supports.size();
  for (retarget::SupportTrack& track : planned_supports(state)) {
    split.supports.push_back(std::move(track));
  }
  Motion from_zero = state.motion;
  from_zero.first_frame = 0;  // Times of constraints are since the first pose.
  auto adapted =
      retarget::adapt_motion(from_zero, *character, split.others, split.supports);
  if (!adapted) {
    state.motion = before;
    return adapted.error();
  }
  take_adapted(std::move(adapted->motion.poses), state);
  report_adapted(*adapted, own_supports, state.motion.rate.hz, report);
  report.figures.emplace_back("slide_mm", measure_slide(state).worst_drift_mm);
  report.figures.emplace_back(
      "displaced_mm",
      kToMm * mark_displaced(
                  state, before, changed_frames(before, state.motion), report.index));
  return Done{};
}

}  // namespace marey::edit
