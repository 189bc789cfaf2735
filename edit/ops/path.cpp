// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "edit/find/travel_path.h"
#include "edit/ops/path_change.h"
#include "edit/state/check_op_keys.h"
#include "edit/state/move_state.h"
#include "edit/state/plant_feet.h"
#include "edit/state/resample_state.h"
#include "edit/state/resolve_moment.h"
#include <glm/geometric.hpp>

#include "core/base/degrees.h"
#include "core/base/format_text.h"
#include "retarget/contacts/frame_marks.h"

namespace marey::edit {
namespace {

/// The root of a motion that travels moves at least this far. [leg lengths]
constexpr double kMinTravelInLegs = 0.5;
/// Longer steps lower the hips: a bearing leg is not extended further than this, or than
/// it was. Straighter knees stretch and fold faster: at 20 % longer steps, 1.36 times the
/// source's speed without this limit, 1.07 times with it (docs/accuracy).
constexpr double kBentLeg = 0.95;

Status check_path_op(const PathOp& op, const EditOp& with) {
  if (const Status ok = check_op_keys(with, {.span = true}); !ok) return ok;
  if (op.points_xz_m.empty()) return Done{};
  if (op.turn_rad != 0.0 || op.length != 1.0 || op.straight) {
    return bad_input("points",
                     "the points give the whole path, with its turn and its length",
                     "give either points, or turn_deg, length and straight");
  }
  for (std::size_t i = 1; i < op.points_xz_m.size(); ++i) {
    constexpr double kApart_m = 0.01;
    if (glm::distance(op.points_xz_m[i], op.points_xz_m[i - 1]) >= kApart_m) continue;
    return bad_input("points",
                     "points " + std::to_string(i) + " and " + std::to_string(i + 1) +
                         " are closer than 1 cm",
                     "remove one of them");
  }
  return Done{};
}

Result<FrameRange> span_frames(const EditState& state, const EditSpan& span) {
  const auto resolved = resolve_span(state, span);
  if (!resolved) return resolved.error();
  constexpr double kRounding = 1e-6;
  return FrameRange{static_cast<int>(std::ceil(resolved->first - kRounding)),
                    static_cast<int>(std::floor(resolved->last + kRounding))};
}

Status check_travel(const TravelPath& path, const FrameRange& span, double leg_m) {
  const double travel_m = span.last > span.first ? extent_m(path, span) : 0.0;
  if (travel_m >= kMinTravelInLegs * leg_m) return Done{};
  return bad_input("",
                   "the body travels " + format_text("%.2f m", travel_m) +
                       ", less than half a leg length (" +
                       format_text("%.2f m", kMinTravelInLegs * leg_m) +
                       "): there is no path to bend",
                   "use place to move or turn a motion that stays in place");
}

void move_root(const RigidTransform& moved_from_old, Pose& pose) {
  pose.root_in_world = moved_from_old * pose.root_in_world;
  pose.parent_from_joint[0] =
      glm::normalize(moved_from_old.rotation * pose.parent_from_joint[0]);
}

retarget::FootPlace moved_foot(const RigidTransform& moved_from_old,
                               const retarget::FootPlace& foot) {
  return {moved_from_old * foot.ankle_in_world,
          moved_from_old.rotation * foot.foot,
          moved_from_old.rotation * foot.toes};
}

/// Returns the stances with the swings in which a leg must reach as well: a foot that is
/// about to land is far ahead. Longer swings (kicks, jumps) count near their stances
/// only.
std::vector<FrameRange> with_swings(const std::vector<FrameRange>& stances,
                                    double hz,
                                    int frame_count) {
  constexpr double kNear_s = 0.15;
  constexpr double kStep_s = 0.8;
  const int near = static_cast<int>(std::lround(kNear_s * hz));
  const int step = static_cast<int>(std::lround(kStep_s * hz));
  std::vector<FrameRange> out;
  for (const FrameRange& stance : stances) {
    const int before = out.empty() ? 0 : out.back().last + 1;
    if (stance.first - before > step) {
      out.push_back({stance.first - near, stance.last});
    } else if (out.empty()) {
      out.push_back({0, stance.last});
    } else {
      out.back().last = stance.last;
      continue;
    }
    if (out.size() > 1) out[out.size() - 2].last += near;
  }
  if (out.empty()) return out;
  const int left = frame_count - 1 - out.back().last;
  out.back().last += left > step ? near : left;
  return out;
}

/// Moves the root with the path at each frame, and the feet with the path at the instants
/// of their stances.
PlantReport move_body(const PathChange& change,
                      const FrameRange& span,
                      EditState& state) {
  const int count = state.frame_count();
  std::array<std::vector<std::optional<retarget::FootPlace>>, 2> feet;
  for (int side = 0; side < 2; ++side) {
    const auto s = static_cast<std::size_t>(side);
    const auto places = foot_places(state, side);
    const auto instants =
        foot_instants(state.contacts.feet[s].stance, count, span, state.motion.rate.hz);
    feet[s].resize(places.size());
    for (auto t = static_cast<std::size_t>(span.first); t < places.size(); ++t) {
      feet[s][t] = moved_foot(change.moved_from_old(instants[t]), places[t]);
    }
  }
  for (int frame = span.first; frame < count; ++frame) {
    move_root(change.moved_from_old(frame),
              state.motion.poses[static_cast<std::size_t>(frame)]);
  }
  retarget::GroundOptions ground;
  ground.straight = kBentLeg;
  const Contacts contacts = state.contacts;
  for (auto& foot : state.contacts.feet) {
    foot.stance = with_swings(foot.stance, state.motion.rate.hz, count);
  }
  const PlantReport planted = set_feet(state, feet, {ground});
  state.contacts = contacts;
  return planted;
}

/// Returns whether the world's axes limit a constraint.
bool is_space(const Constraint& constraint) {
  return std::holds_alternative<AllowedSpace>(constraint.goal) ||
         std::holds_alternative<ForbiddenSpace>(constraint.goal);
}

/// Moves the constraints; returns a finding for each one without an exact image.
void move_constraints(const PathChange& change, EditState& state, OpReport& report) {
  const double duration_s = state.duration_s();
  for (Constraint& constraint : state.constraints.constraints) {
    const double hz = state.motion.rate.hz;
    const Activation& active = constraint.activation;
    const double from = std::clamp(active.start_s.value_or(0.0), 0.0, duration_s) * hz;
    const double to =
        std::clamp(active.stop_s.value_or(duration_s), 0.0, duration_s) * hz;
    const Goal before = constraint.goal;
    move_constraint(change.moved_from_old(0.5 * (from + to)), constraint);
    if (is_space(constraint)) {
      report.findings.push_back(
          fair_finding("constraint_space",
                       "constraint " + constraint.id,
                       "the space moved with the path, but stays along the world's axes",
                       "check its limits"));
    }
    const auto* goal = std::get_if<DistanceToPoint>(&before);
    if (goal == nullptr) continue;
    const double apart_m = glm::distance(change.moved_from_old(from) * goal->p_in_world,
                                         change.moved_from_old(to) * goal->p_in_world);
    constexpr double kApart_m = 0.05;
    if (apart_m <= kApart_m) continue;
    report.findings.push_back(
        fair_finding("constraint_travel",
                     "constraint " + constraint.id,
                     "the path moves its point by " + format_text("%.2f m", apart_m) +
                         " while it is active; the middle of its time was used",
                     "check the point, or divide the constraint")
            .measured(apart_m, kApart_m, "m"));
  }
}

struct TurnRate {
  double deg_per_s = 0.0;
  double old_deg_per_s = 0.0;
  int frame = 0;
};

/// Returns the largest turn rate of the path while both feet bear, if it grew.
TurnRate turn_rate(const TravelPath& old, const NewPath& made, const EditState& state) {
  const auto count = static_cast<std::size_t>(state.frame_count());
  const auto left = retarget::frame_marks(state.contacts.feet[0].stance, count);
  const auto right = retarget::frame_marks(state.contacts.feet[1].stance, count);
  TurnRate out;
  for (std::size_t t = 1; t + 1 < count; ++t) {
    if (!left[t] || !right[t]) continue;
    const double half_hz = 0.5 * state.motion.rate.hz * kDegreesPerRadian;
    const double was = (old.heading_rad[t + 1] - old.heading_rad[t - 1]) * half_hz;
    const double rate = was + (made.turn_rad[t + 1] - made.turn_rad[t - 1]) * half_hz;
    if (std::abs(rate) <= out.deg_per_s) continue;
    out = {std::abs(rate), std::abs(was), static_cast<int>(t)};
  }
  return out;
}

void report_path(const TravelPath& old,
                 const NewPath& made,
                 const FrameRange& span,
                 const EditState& state,
                 OpReport& report) {
  const auto first = static_cast<std::size_t>(span.first);
  const auto last = static_cast<std::size_t>(span.last);
  const TurnRate rate = turn_rate(old, made, state);
  report.figures.emplace_back("length_m", old.way_m[last] - old.way_m[first]);
  report.figures.emplace_back("new_length_m", made.length_m);
  report.figures.emplace_back(
      "turn_deg", (made.turn_rad[last] - made.turn_rad[first]) * kDegreesPerRadian);
  report.figures.emplace_back("turn_rate_deg_per_s", rate.deg_per_s);
  constexpr double kMaxRate = 60.0;
  constexpr double kGrown = 1.0;
  if (rate.deg_per_s <= kMaxRate || rate.deg_per_s < rate.old_deg_per_s + kGrown) return;
  report.findings.push_back(fair_finding("turn_rate",
                                         "frame " + std::to_string(rate.frame),
                                         "the path turns by " +
                                             format_text("%.0f deg/s", rate.deg_per_s) +
                                             " while both feet bear",
                                         "use a wider curve, or more steps")
                                .measured(rate.deg_per_s, kMaxRate, "deg/s"));
}

double root_sunk_m(const Motion& before, const Motion& after) {
  double sunk = 0.0;
  for (std::size_t t = 0; t < before.poses.size(); ++t) {
    sunk =
        std::max(sunk, before.poses[t].root_in_world.y - after.poses[t].root_in_world.y);
  }
  return sunk;
}

void report_legs(const PlantReport& planted,
                 const Motion& before,
                 const Motion& after,
                 OpReport& report) {
  report.figures.emplace_back("unreachable_frames", planted.unreachable_frames);
  report.figures.emplace_back("root_sunk_mm", 1e3 * root_sunk_m(before, after));
  if (planted.unreachable_frames == 0) return;
  report.findings.push_back(fair_finding("unreachable",
                                         "legs",
                                         "a leg does not reach its footprint in " +
                                             std::to_string(planted.unreachable_frames) +
                                             " frames",
                                         "use a wider curve or a shorter path")
                                .measured(planted.unreachable_frames, 0.0, "frames"));
}

}  // namespace

Result<EditState> apply_path(const PathOp& op,
                             const OpContext& context,
                             const EditState& state,
                             OpReport& report) {
  if (const Status ok = check_path_op(op, context.op); !ok) return ok.error();
  const auto span = span_frames(state, context.op.span);
  if (!span) return span.error();
  const TravelPath old = find_travel_path(state);
  if (const Status ok = check_travel(old, *span, state.map.leg_length_m); !ok) {
    return ok.error();
  }
  const auto made = make_new_path(op, old, *span);
  if (!made) return made.error();
  EditState out = state;
  const PathChange change(old, *made);
  const PlantReport planted = move_body(change, *span, out);
  move_constraints(change, out, report);
  report_path(old, *made, *span, state, report);
  report_legs(planted, state.motion, out.motion, report);
  const FrameRange touched{span->first, state.frame_count() - 1};
  report.figures.emplace_back(
      "displaced_mm",
      1e3 * mark_displaced(out, state.motion, touched, context.index, true));
  return out;
}

}  // namespace marey::edit
