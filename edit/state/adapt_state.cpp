// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/state/adapt_state.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "edit/state/constraint_copies.h"
#include "edit/state/full_time.h"
#include "edit/state/plant_feet.h"
#include "edit/state/resample_state.h"
#include "edit/state/support_tracks.h"
#include <glm/geometric.hpp>

#include "core/base/degrees.h"
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
/// A planted foot that is nearer to its support than this stands on it, or moves there
/// while the support fades. [m]
constexpr double kPlanted_m = 1e-4;
constexpr double kPlantedFade_m = 2e-3;
constexpr double kPlantedTurn = 1.0 - 1e-6;  ///< Cosine of half an angle of 0.16 degrees.
/// A detected touch is of millimetres. One that is missed by more was no touch, or
/// contradicts another one. [m]
constexpr double kTouchMissed_m = 0.010;
constexpr double kToMm = 1e3;

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

/// Returns true if a planted foot departs from its support by more than the tolerance.
bool is_displaced(const EditState& state,
                  const retarget::SupportTrack& track,
                  int frame,
                  std::span<const RigidTransform> joints) {
  const BodyPoint& point = track.constraint.point;
  const auto joint = retarget::resolve_segment(state.motion.skeleton, point.segment);
  if (!joint) return true;
  const auto t = static_cast<std::size_t>(frame);
  const glm::dquat turn =
      joints[index(*joint)].rotation *
      glm::conjugate(state.map.joints[index(*joint)].t_pose_from_joint);
  const glm::dvec3 place =
      joints[index(*joint)].translation + turn * point.offset_in_t_pose;
  const Activation& when = track.constraint.activation;
  const double hz = state.motion.rate.hz;
  const auto acts = [&](double before_s, double after_s) {
    return std::any_of(
        track.bears.begin(), track.bears.end(), [&](const FrameRange& run) {
          return frame > run.first - 1 - before_s * hz &&
                 frame < run.last + 1 + after_s * hz;
        });
  };
  if (!acts(when.start_duration_s, when.stop_duration_s)) return false;
  const bool bears = acts(0.0, 0.0);
  const double tolerance_m = bears ? kPlanted_m : kPlantedFade_m;
  if (glm::distance(place, track.p_in_world[t]) > tolerance_m) return true;
  return bears && !track.world_from_t_pose.empty() &&
         std::abs(glm::dot(turn, track.world_from_t_pose[t])) < kPlantedTurn;
}

/// Takes the adapted poses, except where only the adapter's rounding changed them, and
/// where the planted feet meet the supports already and nothing else acts. There the
/// adapter has nothing to add, but may bend a knee that is straight.
void take_adapted(std::vector<Pose> adapted,
                  const SplitConstraints& split,
                  EditState& state) {
  const Skeleton& skeleton = state.motion.skeleton;
  std::vector<RigidTransform> old_joints(skeleton.joints.size());
  std::vector<RigidTransform> new_joints(skeleton.joints.size());
  for (int frame = 0; frame < state.frame_count(); ++frame) {
    const auto t = static_cast<std::size_t>(frame);
    const double way_m = largest_way_m(
        skeleton, state.motion.poses[t], adapted[t], old_joints, new_joints);
    const double time_s = frame / state.motion.rate.hz;
    if (way_m < kAdapterNoise_m && !acts_at(state.constraints, time_s)) continue;
    const bool has_work =
        acts_at(split.others, time_s) ||
        std::any_of(split.supports.begin(), split.supports.end(), [&](const auto& track) {
          return is_displaced(state, track, frame, old_joints);
        });
    if (!has_work) continue;
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

/// Returns the largest acceleration of the joints relative to their path before.
double added_m_per_s2(const Motion& before, const Motion& after) {
  const Skeleton& skeleton = before.skeleton;
  std::vector<RigidTransform> was(skeleton.joints.size());
  std::vector<RigidTransform> is(skeleton.joints.size());
  std::vector<std::array<glm::dvec3, 2>> earlier(was.size(),
                                                 {glm::dvec3(0.0), glm::dvec3(0.0)});
  double largest_m = 0.0;
  for (std::size_t t = 0; t < after.poses.size(); ++t) {
    world_from_joints(skeleton, before.poses[t], was);
    world_from_joints(skeleton, after.poses[t], is);
    for (std::size_t j = 0; j < was.size(); ++j) {
      const glm::dvec3 away = is[j].translation - was[j].translation;
      const glm::dvec3 bend = away - 2.0 * earlier[j][1] + earlier[j][0];
      if (t >= 2) largest_m = std::max(largest_m, glm::length(bend));
      earlier[j] = {earlier[j][1], away};
    }
  }
  return largest_m * after.rate.hz * after.rate.hz;
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
  const double error = kept.is_orientation ? kDegreesPerRadian * kept.worst_error_rad
                                           : kToMm * kept.worst_error_m;
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

/// Returns the detected touches that are missed by far, the worst first. Touches that act
/// at the same time as a worse one stay for now, because they may be met without it.
std::vector<std::string> missed_touches(const ConstraintSet& set,
                                        const retarget::AdaptedMotion& adapted) {
  std::vector<const retarget::KeptConstraint*> missed;
  for (const retarget::KeptConstraint& kept : adapted.constraints) {
    if (is_found(kept.id) && !kept.is_support && kept.worst_error_m > kTouchMissed_m) {
      missed.push_back(&kept);
    }
  }
  std::stable_sort(missed.begin(), missed.end(), [](const auto* a, const auto* b) {
    return a->worst_error_m > b->worst_error_m;
  });
  std::vector<std::string> out;
  for (const retarget::KeptConstraint* kept : missed) {
    const FullTime at = full_time(set.find(kept->id)->activation);
    const bool is_with_worse =
        std::any_of(out.begin(), out.end(), [&](const std::string& id) {
          return overlap(full_time(set.find(id)->activation), at);
        });
    if (!is_with_worse) out.push_back(kept->id);
  }
  return out;
}

/// Adapts to the constraints without the detected touches that no posture meets, because
/// they would pull the body. Removes these touches from `set`, with a finding each.
Result<retarget::AdaptedMotion> adapt_to_possible(
    const Motion& motion,
    const Character& character,
    std::span<const retarget::SupportTrack> supports,
    ConstraintSet& set,
    OpReport& report) {
  int left_out = 0;
  while (true) {
    auto adapted = retarget::adapt_motion(motion, character, set, supports);
    if (!adapted) return adapted;
    const std::vector<std::string> missed = missed_touches(set, *adapted);
    if (missed.empty()) {
      report.figures.emplace_back("left_out", left_out);
      return adapted;
    }
    for (const std::string& id : missed) {
      const auto kept =
          std::find_if(adapted->constraints.begin(),
                       adapted->constraints.end(),
                       [&](const auto& constraint) { return constraint.id == id; });
      report.findings.push_back(
          fair_finding("touch_left_out",
                       "constraint " + in_quotes(id),
                       format_text("it was left out, because its error remains %.1f mm "
                                   "at %.2f s",
                                   kToMm * kept->worst_error_m,
                                   *kept->worst_frame / motion.rate.hz),
                       "place it by hand, if the hand touches there")
              .measured(kToMm * kept->worst_error_m, kToMm * kTouchMissed_m, "mm"));
      std::erase_if(set.constraints, [&](const Constraint& c) { return c.id == id; });
      ++left_out;
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
  const ConstraintSet wanted = split.others;
  auto adapted =
      adapt_to_possible(from_zero, *character, split.supports, split.others, report);
  if (!adapted) {
    state.motion = before;
    return adapted.error();
  }
  std::erase_if(state.constraints.constraints, [&](const Constraint& c) {
    return wanted.find(c.id) != nullptr && split.others.find(c.id) == nullptr;
  });
  const Motion planted = state.motion;
  take_adapted(std::move(adapted->motion.poses), split, state);
  report_adapted(*adapted, own_supports, state.motion.rate.hz, report);
  report.figures.emplace_back("added_acceleration_m_per_s2",
                              added_m_per_s2(planted, state.motion));
  report.figures.emplace_back("slide_mm", measure_slide(state).worst_drift_mm);
  report.figures.emplace_back(
      "displaced_mm",
      kToMm * mark_displaced(
                  state, before, changed_frames(before, state.motion), report.index));
  return Done{};
}

}  // namespace marey::edit
