// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/splice/join_motions.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "edit/splice/bridge_stances.h"
#include "edit/splice/plant_near.h"
#include "edit/splice/splice_carry.h"
#include "edit/splice/splice_poses.h"
#include "edit/state/move_state.h"
#include "edit/state/resample_state.h"
#include <glm/geometric.hpp>

#include "core/base/degrees.h"
#include "retarget/feet/adapt_to_ground.h"

namespace marey::edit {
namespace {

// Time around the planted feet in which the root may sink. [s]
constexpr double kSpliceSink_s = 0.2;

// The two motions of a splice, on their way to one.
struct SpliceParts {
  EditState first;   // Up to the end of the overlap.
  EditState second;  // From its start.
  SpliceOverlap overlap;
  JoinFrames frames;
  bool is_seamless = false;  // Both show identical frames: nothing is changed.
};

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
                        const JoinPlan& plan) {
  const SpliceCandidate& pair = plan.pair;
  SpliceOverlapOptions options{plan.overlap_frames, plan.upper_frames, false};
  SpliceParts parts;
  parts.overlap = plan_splice_overlap(first, pair.leave, second, pair.enter, options);
  parts.is_seamless = has_identical_frames(first, second, pair, parts.overlap);
  if (!parts.is_seamless) {
    options.align_supports = true;
    parts.overlap = plan_splice_overlap(first, pair.leave, second, pair.enter, options);
  }
  const double hz = first.motion.rate.hz;
  parts.first = resample_state(
      first, frames_with(parts.overlap.first_at, first.frame_count(), true), hz);
  parts.first.motion.first_frame = first.motion.first_frame;
  parts.second = resample_state(
      second, frames_with(parts.overlap.second_at, second.frame_count(), false), hz);
  const int start = static_cast<int>(std::lround(parts.overlap.first_at.front()));
  parts.frames.start = start;
  parts.frames.join = start + parts.overlap.join();
  parts.frames.body = parts.overlap.body;
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
                 int op,
                 JoinedMotion& joined) {
  EditState& out = joined.state;
  const Motion plain = out.motion;
  const FrameRange overlap{parts.frames.start, parts.frames.start + parts.overlap.last()};
  const int body_first = parts.frames.start + parts.frames.body.first;
  FrameRange changed{body_first, body_first + parts.overlap.body_frames()};
  if (parts.overlap.last() > 0) {
    mix_overlap(parts.first, parts.second, parts.frames, out);
  } else {
    changed =
        united(changed,
               displace_join(parts.first, parts.second, parts.frames, blend_frames, out));
  }
  const FootWays feet = bridge_stances(parts.first, parts.second, parts.frames, out);
  const PlantNearReport planted = plant_feet_near(out, changed, feet);
  joined.unreachable_frames = planted.plant.unreachable_frames;
  report_planted(planted, joined.report);
  const int sink = static_cast<int>(std::ceil(kSpliceSink_s * out.motion.rate.hz));
  joined.changed =
      united(overlap, widened(united(changed, planted.changed), sink, out.frame_count()));
  mark_join(overlap, joined.changed, plain, op, joined.report, out);
}

}  // namespace

JoinedMotion join_motions(const EditState& first,
                          const EditState& second,
                          const JoinPlan& plan,
                          int op) {
  SpliceParts parts = split_parts(first, second, plan);
  JoinedMotion out;
  out.is_seamless = parts.is_seamless;
  if (!parts.is_seamless && plan.align) {
    align_second(first, second, plan.pair, parts, out.report);
  }
  parts.frames.weight = parts.overlap.weight;
  parts.frames.upper_weight = parts.overlap.upper_weight;
  out.state = join_states(parts.first, parts.second, parts.frames, out.report);
  if (parts.is_seamless) {
    touch(out.state.lineage, {parts.frames.join + 1, out.state.frame_count() - 1}, op);
    out.changed = {0, -1};
  } else {
    smooth_join(parts, plan.blend_frames, op, out);
  }
  out.overlap = std::move(parts.overlap);
  return out;
}

}  // namespace marey::edit
