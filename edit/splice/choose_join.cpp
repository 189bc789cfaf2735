// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/splice/choose_join.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "edit/state/op_weights.h"
#include "edit/state/resample_state.h"

namespace marey::edit {
namespace {

// Part of a motion in which joins are tried: on the side of the pair that the result
// shows, and beyond it, where only the overlap does. [s]
constexpr double kShown_s = 4.0;
constexpr double kBeyond_s = 1.0;

// A join that was made and measured.
struct JoinTrial {
  JoinPlan plan;
  bool is_seamless = false;
  bool has_overlap = false;
  bool reaches = true;
  double peak_m_per_s2 = 0.0;
  bool is_upper = false;  // The joint of the peak is one of trunk, head and arms.
};

bool is_better(const JoinTrial& a, const JoinTrial& b) {
  if (a.reaches != b.reaches) return a.reaches;
  return a.peak_m_per_s2 < b.peak_m_per_s2;
}

// Frames round a place, as far as the motion has them.
FrameRange frames_round(const EditState& state,
                        int frame,
                        double before_s,
                        double after_s) {
  const double hz = state.motion.rate.hz;
  return {std::max(0, frame - static_cast<int>(std::lround(before_s * hz))),
          std::min(state.frame_count() - 1,
                   frame + static_cast<int>(std::lround(after_s * hz)))};
}

// Makes and measures joins of one pair.
class PairTrials {
 public:
  PairTrials(const EditState& first, const EditState& second, const SpliceCandidate& pair)
      : pair_(pair) {
    const FrameRange kept_a = frames_round(first, pair.leave, kShown_s, kBeyond_s);
    const FrameRange kept_b = frames_round(second, pair.enter, kBeyond_s, kShown_s);
    first_ = slice_state(first, kept_a);
    second_ = slice_state(second, kept_b);
    local_ = pair;
    local_.leave -= kept_a.first;
    local_.enter -= kept_b.first;
    const Skeleton& skeleton = first.motion.skeleton;
    for (const EditGroup group : groups_of_joints(skeleton)) groups_.push_back(group);
  }

  [[nodiscard]] JoinTrial make(JoinPlan plan) const {
    JoinTrial out;
    out.plan = plan;
    out.plan.pair = pair_;
    plan.pair = local_;
    const JoinedMotion joined = join_motions(first_, second_, plan, 0);
    out.is_seamless = joined.is_seamless;
    out.has_overlap = joined.overlap.last() > 0;
    if (joined.is_seamless) return out;
    const auto peak = peak_acceleration(
        joined.state.motion, {joined.changed.first - 1, joined.changed.last + 1});
    out.peak_m_per_s2 = peak.m_per_s2;
    out.is_upper = is_upper(peak.bone);
    out.reaches = joined.unreachable_frames == 0;
    return out;
  }

 private:
  [[nodiscard]] bool is_upper(HumanBone bone) const {
    const auto joint = first_.motion.skeleton.find(bone);
    if (!joint) return false;
    const EditGroup group = groups_[index(*joint)];
    return group != EditGroup::kRoot && group != EditGroup::kLeftLeg &&
           group != EditGroup::kRightLeg;
  }

  SpliceCandidate pair_;
  SpliceCandidate local_;  // In the frames of the cut motions.
  EditState first_;
  EditState second_;
  std::vector<EditGroup> groups_;
};

// Keeps the better one; returns true if it is good enough.
bool keep_better(const JoinTrial& trial, double limit, JoinTrial& best) {
  if (trial.is_seamless || is_better(trial, best)) best = trial;
  return trial.is_seamless || (trial.reaches && trial.peak_m_per_s2 <= limit);
}

// Tries longer decays of a join without an overlap; returns true if one is good enough.
bool try_blends(const PairTrials& trials,
                const JoinChoices& choices,
                JoinPlan plan,
                JoinTrial& best) {
  for (std::size_t k = 1; k < choices.blends.size(); ++k) {
    plan.blend_frames = choices.blends[k];
    if (keep_better(trials.make(plan), choices.max_m_per_s2, best)) return true;
  }
  return false;
}

// Tries the joins of one pair; returns true if one is good enough.
bool try_pair(const PairTrials& trials, const JoinChoices& choices, JoinTrial& best) {
  JoinPlan plan;
  plan.blend_frames = choices.blends.front();
  plan.align = choices.align;
  for (const int overlap : choices.overlaps) {
    plan.overlap_frames = overlap;
    plan.upper_frames = 0;
    JoinTrial trial = trials.make(plan);
    if (keep_better(trial, choices.max_m_per_s2, best)) return true;
    // At the end of a motion longer overlaps have no frames either.
    if (!trial.has_overlap) return try_blends(trials, choices, plan, best);
    for (const int upper : choices.upper_overlaps) {
      if (!trial.is_upper) break;
      if (upper <= overlap) continue;
      plan.upper_frames = upper;
      trial = trials.make(plan);
      if (keep_better(trial, choices.max_m_per_s2, best)) return true;
    }
  }
  return false;
}

}  // namespace

JoinPlan choose_join(const EditState& first,
                     const EditState& second,
                     const JoinChoices& choices) {
  JoinTrial best;
  best.reaches = false;
  best.peak_m_per_s2 = std::numeric_limits<double>::infinity();
  best.plan = {choices.pairs.front(),
               choices.overlaps.front(),
               0,
               choices.blends.front(),
               choices.align};
  for (const SpliceCandidate& pair : choices.pairs) {
    if (try_pair(PairTrials(first, second, pair), choices, best)) break;
  }
  return best.plan;
}

}  // namespace marey::edit
