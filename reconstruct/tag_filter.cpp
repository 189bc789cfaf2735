// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tag_filter.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace marey::reconstruct {
namespace {

// Tags of a frame say less than markers: how people move says more, and what they usually
// do, of whom a part may not be seen at all.
constexpr double kBrisk = 1.2;
constexpr double kHabitMemory_s = 0.1;
// The body is lost where less than this of what is seen is explained.
constexpr double kExplained = 0.5;
constexpr std::size_t kFewestToJudge = 3;
// Nor is a tag somebody else's that is off by less: detectors may be surer than they are.
constexpr double kNear_px = 1.5;
// Who is lost and not found is looked for again so much later, limbs that do not fit
// likewise.
constexpr double kBetweenLooks_s = 0.15;
// Of a body's parts, beside what is known of their speed.
constexpr double kUnknownSpeed_m_s = 0.5;
// After so long without a picture nothing is expected of speeds, and time stands still.
constexpr double kLongestStep_s = 2.0;

}  // namespace

TagFilter::TagFilter(const TagModel& model,
                     FrameRate rate,
                     const std::vector<bool>& lag_known)
    : model_(&model),
      nominal_(rate),
      process_(model.lengths, rate, {kBrisk, kHabitMemory_s}),
      solver_(model),
      finder_(model),
      readings_(model),
      lags_(lag_known),
      late_frames_(model.cameras.size(), 0.0),
      late_sigma_frames_(model.cameras.size(), 0.0),
      lateness_(model.cameras.size()) {
  fits_.reserve(model.tags.size() * model.cameras.size());
  drift_.late_frames = late_frames_;
  drift_.late_sigma_frames = late_sigma_frames_;
  drift_.expected = &predicted_.posture;
  beside_ = {&prior_, &drift_, &slips_.sigmas_m()};
}

bool TagFilter::is_used(const TagFit& fit) {
  return fit.squared < kDoubtfulTag * kDoubtfulTag || fit.rms_px < kNear_px;
}

TagLimits TagFilter::limits() const {
  TagLimits limits;
  limits.habit_share = process_.habit_share();
  return limits;
}

void TagFilter::start(const Posture& posture) {
  predicted_ = process_.start(posture);
  started_ = true;
  look_anew_ = false;
  astray_s_ = 0.0;
  limb_astray_s_.fill(0.0);
}

/// Steps as near to the nominal frame as whole numbers of them allow.
void TagFilter::predict(double since_s) {
  const double span_s = std::min(since_s, kLongestStep_s);
  const auto steps = std::max(1L, std::lround(span_s * nominal_.hz));
  const double hz = static_cast<double>(steps) / span_s;
  if (hz != process_.rate().hz) process_.change_rate(FrameRate{hz}, filtered_);
  for (long i = 0; i < steps; ++i) {
    process_.predict(filtered_, predicted_);
    if (i + 1 < steps) std::swap(filtered_, predicted_);
  }
}

/// What is known of the frame before it is looked at.
void TagFilter::prepare(std::span<const double> late_s) {
  SlotProcess::to_prior(predicted_, prior_);
  drift_.step = predicted_.step;
  drift_.speed_sigma_m = kUnknownSpeed_m_s / process_.rate().hz;
  for (const Slot slot : kAllSlots) {
    const auto& c = predicted_.covariance[index(slot)];
    Eigen::Matrix3d& gain = drift_.gain[index(slot)];
    gain.setZero();
    if (tangent_size(slot) == 3) {
      gain = c.block<3, 3>(3, 0) * c.topLeftCorner<3, 3>().inverse();
    } else {
      gain(0, 0) = c(1, 0) / c(0, 0);
    }
  }
  for (std::size_t c = 0; c < late_frames_.size(); ++c) {
    late_frames_[c] = (late_s[c] + lags_.lags_s()[c]) * process_.rate().hz;
    late_sigma_frames_[c] = lags_.sigma_s(c) * process_.rate().hz;
  }
}

void TagFilter::refine(std::span<const SeenTag> seen, Posture& posture) {
  (void)solver_.solve(seen, beside_, posture, limits());
  bool turned = false;
  for (const ChainEnd& end : kChainEnds) {
    if (!readings_.reconsider(
            end, seen, beside_, predicted_.posture.rotation(end.slot), posture)) {
      continue;
    }
    forget(std::array{end.slot}, posture);
    turned = true;
  }
  if (turned) (void)solver_.solve(seen, beside_, posture, limits());
}

/// What was expected of these slots was wrong: they are as in `posture`, give or take.
void TagFilter::forget(std::span<const Slot> slots, const Posture& posture) {
  const PostureBelief anew = process_.start(posture);
  for (const Slot slot : slots) {
    std::copy_n(posture.block(slot), block_size(slot), predicted_.posture.block(slot));
    predicted_.step.segment(column_of(slot), tangent_size(slot)).setZero();
    predicted_.covariance[index(slot)] = anew.covariance[index(slot)];
    drift_.step.segment(column_of(slot), tangent_size(slot)).setZero();
  }
  SlotProcess::to_prior(predicted_, prior_);
}

double TagFilter::unexplained(std::span<const SeenTag> seen, const Posture& posture) {
  fits_.resize(seen.size());
  solver_.fit(seen, beside_, posture, fits_);
  const auto off = std::count_if(
      fits_.begin(), fits_.end(), [](const TagFit& f) { return !is_used(f); });
  return static_cast<double>(off) /
         static_cast<double>(std::max<std::size_t>(1, fits_.size()));
}

/// What does not fit is looked for elsewhere: the body where it is lost, a limb where it
/// has bent the wrong way.
void TagFilter::mend(std::span<const SeenTag> seen,
                     std::span<const double> late_s,
                     double since_s,
                     Posture& posture) {
  const double off = unexplained(seen, posture);
  const bool judged = seen.size() >= kFewestToJudge;
  if (judged) astray_s_ = off > 1.0 - kExplained ? astray_s_ + since_s : 0.0;
  until_next_look_s_ = std::max(0.0, until_next_look_s_ - since_s);
  if (until_next_look_s_ > 0.0) return;
  if (judged && (astray_s_ > 0.0 || (look_anew_ && off > 0.0))) {
    until_next_look_s_ = kBetweenLooks_s;
    const auto found = finder_.find(seen);
    if (!found) return;
    Posture other = *found;
    if (unexplained(seen, other) < off) {
      start(other);
      prepare(late_s);
      posture = other;
      (void)solver_.solve(seen, beside_, posture, limits());
    }
    (void)unexplained(seen, posture);
    return;
  }
  for (std::size_t limb = 0; limb < kLimbSlots.size(); ++limb) {
    if (!finder_.limb_misfits(limb, seen, fits_)) {
      limb_astray_s_[limb] = 0.0;
      continue;
    }
    limb_astray_s_[limb] += since_s;
    until_next_look_s_ = kBetweenLooks_s;
    Posture other = posture;
    if (!finder_.retry_limb(limb, seen, beside_, limits(), other)) continue;
    const LimbSlots& s = kLimbSlots[limb];
    forget(std::array{s.frame, s.flexion, s.upper_twist, s.lower_twist, s.extremity},
           other);
    posture = other;
    (void)solver_.solve(seen, beside_, posture, limits());
    (void)unexplained(seen, posture);
    return;
  }
}

void TagFilter::step(std::span<const SeenTag> seen,
                     std::span<const double> late_s,
                     double since_s) {
  if (!started_) {
    until_next_look_s_ = std::max(0.0, until_next_look_s_ - since_s);
    if (until_next_look_s_ > 0.0 || seen.size() < kFewestToJudge) return;
    const auto found = finder_.find(seen);
    if (!found) {
      until_next_look_s_ = kBetweenLooks_s;
      return;
    }
    start(*found);
  } else {
    predict(since_s);
  }
  prepare(late_s);
  Posture posture = predicted_.posture;
  refine(seen, posture);
  mend(seen, late_s, since_s, posture);
  solver_.factor().covariance(covariance_);
  process_.update(predicted_, posture, covariance_, filtered_);
  learn(seen, since_s, posture);
}

/// What the solved frame says of cameras and skin.
void TagFilter::learn(std::span<const SeenTag> seen,
                      double since_s,
                      const Posture& posture) {
  solver_.slips(seen, beside_, posture, covariance_, slip_scores_);
  if (lags_.any()) {
    solver_.lateness(seen, beside_, posture, limits(), lateness_);
    lags_.update(lateness_, solver_.late_factor(), 1.0 / process_.rate().hz, since_s);
  }
  slips_.update(slip_scores_, since_s);
}

}  // namespace marey::reconstruct
