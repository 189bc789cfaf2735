// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/splice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "edit/find/find_splice.h"
#include "edit/splice/bridge_stances.h"
#include "edit/splice/choose_splice.h"
#include "edit/splice/splice_carry.h"
#include "edit/splice/splice_overlap.h"
#include "edit/splice/splice_poses.h"
#include "edit/splice/splice_source.h"
#include "edit/state/check_op_keys.h"
#include "edit/state/move_state.h"
#include "edit/state/plant_near.h"
#include "edit/state/resample_state.h"
#include <glm/geometric.hpp>

#include "core/base/degrees.h"
#include "core/base/format_text.h"
#include "retarget/feet/adapt_to_ground.h"

namespace marey::edit {
namespace {

// Fade of the displacements of a join without an overlap, if no other is given. [s]
constexpr double kSpliceBlend_s = 0.3;
// Time around the planted feet in which the root may sink. [s]
constexpr double kSpliceSink_s = 0.2;
// A larger difference of postures is reported. [leg lengths]
constexpr double kFitGap_legs = 0.15;

// The two motions of a splice, on their way to one.
struct SpliceParts {
  EditState first;   // Up to the end of the overlap.
  EditState second;  // From its start.
  SpliceOverlap overlap;
  JoinFrames frames;
  bool is_seamless = false;  // Both show identical frames: nothing is changed.
};

Status check_splice(const SpliceOp& op, const EditOp& common, const EditState& state) {
  if (state.motion.poses.empty()) {
    return bad_input("motion", "has no frames", "use another motion");
  }
  if (!(op.overlap_s >= 0.0) || !std::isfinite(op.overlap_s)) {
    return bad_input("overlap_s",
                     format_text("is %g", op.overlap_s),
                     "give 0 or a positive number of seconds");
  }
  if (!(common.blend_s >= 0.0) || !std::isfinite(common.blend_s)) {
    return bad_input("blend_s",
                     format_text("is %g", common.blend_s),
                     "give 0 or a positive number of seconds");
  }
  if (common.blend_s > 0.0 && op.overlap_s > 0.0) {
    return bad_input("blend_s",
                     "has no meaning for splice with an overlap",
                     "remove it, or set overlap_s = 0");
  }
  return check_op_keys(common, {.span = true, .blend = true});
}

bool is_same_pose(const Pose& a, const Pose& b) {
  return a.root_in_world == b.root_in_world && a.parent_from_joint == b.parent_from_joint;
}

// Compares the frames and their neighbours to the bit, as far as both have them.
bool has_identical_frames(const EditState& first,
                          const EditState& second,
                          const SpliceCandidate& pair,
                          const SpliceOverlap& overlap) {
  const int before =
      std::max(1, pair.enter - static_cast<int>(overlap.second_at.front()));
  const int after = std::max(1, static_cast<int>(overlap.second_at.back()) - pair.enter);
  for (int k = -before; k <= after; ++k) {
    const int i = pair.leave + k;
    const int j = pair.enter + k;
    if (i < 0 || j < 0 || i >= first.frame_count() || j >= second.frame_count()) continue;
    if (!is_same_pose(first.motion.poses[static_cast<std::size_t>(i)],
                      second.motion.poses[static_cast<std::size_t>(j)])) {
      return false;
    }
  }
  return true;
}

// Frames of a motion before the overlap (or after it), and in it.
std::vector<double> frames_with(const std::vector<double>& overlap,
                                int frame_count,
                                bool is_first) {
  std::vector<double> out;
  const int start = static_cast<int>(std::lround(overlap.front()));
  const int end = static_cast<int>(std::lround(overlap.back()));
  for (int frame = 0; is_first && frame < start; ++frame) out.push_back(frame);
  out.insert(out.end(), overlap.begin(), overlap.end());
  for (int frame = end + 1; !is_first && frame < frame_count; ++frame) {
    out.push_back(frame);
  }
  return out;
}

SpliceParts split_parts(const EditState& first,
                        const EditState& second,
                        const SpliceCandidate& pair,
                        int overlap_frames) {
  SpliceParts parts;
  parts.overlap =
      plan_splice_overlap(first, pair.leave, second, pair.enter, {overlap_frames, false});
  parts.is_seamless = has_identical_frames(first, second, pair, parts.overlap);
  if (!parts.is_seamless) {
    parts.overlap = plan_splice_overlap(
        first, pair.leave, second, pair.enter, {overlap_frames, true});
  }
  const double hz = first.motion.rate.hz;
  parts.first = resample_state(
      first, frames_with(parts.overlap.first_at, first.frame_count(), true), hz);
  parts.first.motion.first_frame = first.motion.first_frame;
  parts.second = resample_state(
      second, frames_with(parts.overlap.second_at, second.frame_count(), false), hz);
  const int start = static_cast<int>(std::lround(parts.overlap.first_at.front()));
  parts.frames = {start, start + parts.overlap.join(), parts.overlap.weight};
  return parts;
}

bool stands(const EditState& state) {
  return !state.contacts.feet[0].stance.empty() || !state.contacts.feet[1].stance.empty();
}

double floor_of(const EditState& state) {
  return retarget::floor_height_m(state.map,
                                  retarget::ankles_rest_m(state.map, state.contacts));
}

// Moves the second motion to the first one's place and floor.
void align_second(const EditState& first,
                  const EditState& second,
                  const SpliceCandidate& pair,
                  SpliceParts& parts,
                  OpReport& report) {
  RigidTransform move = pair.match.a_from_b.transform();
  if (stands(first) && stands(second)) {
    move.translation.y = floor_of(first) - floor_of(second);
  }
  move_state(move, parts.second);
  const glm::dvec3 gap = footprint_gap(parts.first, parts.second, parts.frames);
  move_state({glm::dquat(1.0, 0.0, 0.0, 0.0), gap}, parts.second);
  move.translation += gap;
  report.figures.emplace_back("turn_deg",
                              pair.match.a_from_b.turn_rad * kDegreesPerRadian);
  report.figures.emplace_back("shift_x_m", move.translation.x);
  report.figures.emplace_back("shift_z_m", move.translation.z);
  report.figures.emplace_back("raised_mm", 1e3 * move.translation.y);
  report.figures.emplace_back("footprint_moved_mm", 1e3 * glm::length(gap));
}

FrameRange widened(const FrameRange& frames, int by, int count) {
  return {std::max(0, frames.first - by), std::min(count - 1, frames.last + by)};
}

FrameRange united(const FrameRange& a, const FrameRange& b) {
  if (a.last < a.first) return b;
  if (b.last < b.first) return a;
  return {std::min(a.first, b.first), std::max(a.last, b.last)};
}

void report_planted(const PlantNearReport& planted, OpReport& report) {
  report.figures.emplace_back("slide_before_mm", planted.plant.slide_before_mm);
  report.figures.emplace_back("slide_after_mm", planted.plant.slide_after_mm);
  if (planted.plant.unreachable_frames == 0) return;
  report.findings.push_back(
      fair_finding("reach",
                   "splice",
                   std::to_string(planted.plant.unreachable_frames) +
                       " frames have a leg that does not reach its footprint",
                   "choose frames that fit better with at and enter_at"));
}

// Marks the invented frames at the join, and touches the frames after it.
void mark_join(const FrameRange& changed,
               const FrameRange& moved,
               const Motion& plain,
               int op,
               OpReport& report,
               EditState& out) {
  const double before_m = mark_displaced(out, plain, {moved.first, changed.first}, op);
  mark_invented(out, {changed.first + 1, changed.last - 1}, op);
  const int rest = std::max(changed.last, changed.first + 1);
  const double after_m = mark_displaced(out, plain, {rest, moved.last}, op);
  touch(out.lineage, {std::max(moved.last + 1, rest), out.frame_count() - 1}, op);
  report.figures.emplace_back("displaced_mm", 1e3 * std::max(before_m, after_m));
}

// Changes the poses of the joined motion round the join.
void smooth_join(const SpliceParts& parts,
                 int blend_frames,
                 const OpContext& context,
                 OpReport& report,
                 EditState& out) {
  const Motion plain = out.motion;
  const FrameRange overlap{parts.frames.start, parts.frames.start + parts.overlap.last()};
  FrameRange changed = overlap;
  if (parts.overlap.last() > 0) {
    mix_overlap(parts.first, parts.second, parts.frames, out);
  } else {
    changed =
        united(changed,
               displace_join(parts.first, parts.second, parts.frames, blend_frames, out));
  }
  const FootWays feet = bridge_stances(parts.first, parts.second, parts.frames, out);
  const PlantNearReport planted = plant_feet_near(out, changed, feet);
  report_planted(planted, report);
  const int sink = static_cast<int>(std::ceil(kSpliceSink_s * out.motion.rate.hz));
  const FrameRange moved =
      widened(united(changed, planted.changed), sink, out.frame_count());
  mark_join(overlap, moved, plain, context.index, report, out);
}

void report_gap(const SpliceOp& op,
                const SpliceCandidate& pair,
                const EditState& first,
                OpReport& report) {
  const double limit_m = kFitGap_legs * first.map.leg_length_m;
  if (pair.match.rms_m <= limit_m) return;
  const char* next = op.at || op.enter_at
                         ? "leave out at and enter_at for the best frames"
                         : "use a motion that begins as this one ends";
  if (!op.align) next = "set align = true, or move the source first";
  report.findings.push_back(
      fair_finding(op.align ? "gap" : "place",
                   "splice",
                   format_text("the postures differ by %.0f mm at the join",
                               1e3 * pair.match.rms_m),
                   next)
          .measured(1e3 * pair.match.rms_m, 1e3 * limit_m, "mm"));
}

void report_supports(const EditState& first,
                     const EditState& second,
                     const SpliceCandidate& pair,
                     OpReport& report) {
  const SupportClass leave = support_class(first.contacts, pair.leave);
  const SupportClass enter = support_class(second.contacts, pair.enter);
  if (supports_oppose(leave, enter)) {
    report.findings.push_back(
        fair_finding("supports",
                     "splice",
                     "the motions stand on opposite feet at the join",
                     "leave out at or enter_at for frames on the same foot"));
  }
  if (leave == SupportClass::kNone && enter == SupportClass::kNone && stands(first) &&
      stands(second)) {
    report.findings.push_back(
        fair_finding("flight",
                     "splice",
                     "no foot bears at the join: the path of the centre of mass in the "
                     "air is a mixture of two jumps",
                     "join where a foot stands, or check the flight in the result"));
  }
}

void report_overlap(const SpliceOp& op,
                    const SpliceOverlap& overlap,
                    double hz,
                    OpReport& report) {
  report.figures.emplace_back("overlap_s", overlap.last() / hz);
  report.figures.emplace_back("aligned_edges", overlap.matched_edges);
  report.figures.emplace_back("warp_ms", 1e3 * overlap.max_warp_s);
  report.figures.emplace_back("opposed_s", overlap.opposed_s);
  if (overlap.last() >= static_cast<int>(std::lround(op.overlap_s * hz))) return;
  report.findings.push_back(
      {Severity::kNote,
       "overlap",
       "splice",
       format_text("the motions have frames for an overlap of %.3f s, not %.3f s",
                   overlap.last() / hz,
                   op.overlap_s),
       "choose frames further from the end of the motion and the start of the source"});
}

}  // namespace

Result<EditState> apply_splice(const SpliceOp& op,
                               const OpContext& context,
                               const EditState& state,
                               OpReport& report) {
  if (const Status ok = check_splice(op, context.op, state); !ok) return ok.error();
  auto second = fit_splice_source(state, op.source, context.inputs, report);
  if (!second) return second.error();
  const EditState& original = context.inputs.sources.at(op.source);
  const auto pair = choose_splice(op, context.op, state, original, *second, report);
  if (!pair) return pair.error();
  const double hz = state.motion.rate.hz;
  report.figures.emplace_back("leave_frame", pair->leave);
  report.figures.emplace_back("enter_frame", pair->enter);
  report.figures.emplace_back("gap_mm", 1e3 * pair->match.rms_m);
  report.figures.emplace_back("velocity_gap_m_per_s", pair->match.rms_velocity_m_per_s);
  SpliceParts parts = split_parts(
      state, *second, *pair, static_cast<int>(std::lround(op.overlap_s * hz)));
  report.figures.emplace_back("unchanged", parts.is_seamless ? 1.0 : 0.0);
  if (!parts.is_seamless) {
    report_gap(op, *pair, state, report);
    report_supports(state, *second, *pair, report);
    report_overlap(op, parts.overlap, hz, report);
    if (op.align) align_second(state, *second, *pair, parts, report);
  }
  parts.frames.weight = parts.overlap.weight;
  EditState out = join_states(parts.first, parts.second, parts.frames, report);
  if (parts.is_seamless) {
    touch(out.lineage, {parts.frames.join + 1, out.frame_count() - 1}, context.index);
    return out;
  }
  const double blend_s = context.op.blend_s > 0.0 ? context.op.blend_s : kSpliceBlend_s;
  smooth_join(parts, static_cast<int>(std::lround(blend_s * hz)), context, report, out);
  return out;
}

}  // namespace marey::edit
