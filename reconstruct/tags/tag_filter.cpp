// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tags/tag_filter.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "reconstruct/tags/tag_loss.h"

namespace marey::reconstruct {
namespace {

// Scale of acceleration noise and time constant of the pose priors. A frame's tags carry
// less information than markers, and parts of the body can be unseen, so the motion model
// and the pose priors have more weight.
constexpr double kAccelerationScale = 1.2;
constexpr double kPriorMemory_s = 0.1;
// The body is lost if less than this share of the sightings is explained.
constexpr double kMaxExplainedSigmas = 0.5;
constexpr std::size_t kMinSeenTags = 3;
// Sightings with smaller errors are never rejected as another person's: detectors' sigmas
// can be too small.
constexpr double kNear_px = 1.5;
// Time between searches without a prior, and between searches for limbs that do not fit.
constexpr double kSearchInterval_s = 0.15;
// Sigma of the speed of a body's parts, in addition to the filter's.
constexpr double kUnknownSpeed_m_s = 0.5;
// After a longer time without a picture speeds are unknown; the prediction covers only
// this time.
constexpr double kMaxFilterStep_s = 2.0;

}  // namespace

TagFilter::TagFilter(const TagModel& model,
                     FrameRate rate,
                     const std::vector<bool>& lag_known)
    : PostureFilter(model, rate, {kAccelerationScale, kPriorMemory_s}),
      model_(&model),
      nominal_(rate),
      relocalizer_(model),
      ambiguity_(model),
      lags_(lag_known),
      late_frames_(model.cameras.size(), 0.0),
      late_sigma_frames_(model.cameras.size(), 0.0),
      lateness_(model.cameras.size()) {
  fits_.reserve(model.tags.size() * model.cameras.size());
  drift_.late_frames = late_frames_;
  drift_.late_sigma_frames = late_sigma_frames_;
  drift_.expected = &predicted_.posture;
  inputs_ = {&prior_, &drift_, &slips_.sigmas_m()};
}

bool TagFilter::is_used(const SightingFit& fit) {
  return fit.squared < kTagLossSigmas2 || fit.rms_px < kNear_px;
}

std::optional<Posture> TagFilter::find(const Frame& frame) {
  until_next_search_s_ = std::max(0.0, until_next_search_s_ - frame.since_s);
  if (until_next_search_s_ > 0.0 || frame.seen.size() < kMinSeenTags) return std::nullopt;
  auto found = relocalizer_.find(frame.seen);
  if (!found) until_next_search_s_ = kSearchInterval_s;
  return found;
}

void TagFilter::restart(const Posture& posture) {
  PostureFilter::restart(posture);
  relocalize_ = false;
  unexplained_s_ = 0.0;
  limb_unexplained_s_.fill(0.0);
}

/// Predicts in whole steps as near to the nominal frame's duration as possible.
void TagFilter::predict(const Frame& frame) {
  const double span_s = std::min(frame.since_s, kMaxFilterStep_s);
  const auto steps = std::max(1L, std::lround(span_s * nominal_.hz));
  const double hz = static_cast<double>(steps) / span_s;
  if (hz != process_.rate().hz) process_.change_rate(FrameRate{hz}, filtered_);
  for (long i = 0; i < steps; ++i) {
    process_.predict(filtered_, predicted_);
    if (i + 1 < steps) std::swap(filtered_, predicted_);
  }
}

/// Sets the prior and the drift of the frame before it is solved.
void TagFilter::prepare(std::span<const double> late_s) {
  PoseParameterProcess::to_prior(predicted_, prior_);
  drift_.step = predicted_.step;
  drift_.speed_sigma_m = kUnknownSpeed_m_s / process_.rate().hz;
  for (const PoseParameter parameter : kAllPoseParameters) {
    const auto& c = predicted_.covariance[index(parameter)];
    Eigen::Matrix3d& gain = drift_.gain[index(parameter)];
    gain.setZero();
    if (tangent_size(parameter) == 3) {
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

void TagFilter::solve(const Frame& frame, Posture& posture) {
  const std::span<const SeenTag> seen = frame.seen;
  prepare(frame.late_s);
  (void)solver_.solve(seen, inputs_, posture, limits());
  bool turned = false;
  for (const ChainEnd& end : kChainEnds) {
    if (!ambiguity_.reconsider(
            end, seen, inputs_, predicted_.posture.rotation(end.parameter), posture)) {
      continue;
    }
    reset_parameters(std::array{end.parameter}, posture);
    turned = true;
  }
  if (turned) (void)solver_.solve(seen, inputs_, posture, limits());
}

/// Resets these parameters to `posture`, with the initial uncertainty: their prediction
/// was wrong.
void TagFilter::reset_parameters(std::span<const PoseParameter> parameters,
                                 const Posture& posture) {
  const PostureEstimate restarted = process_.start(posture);
  for (const PoseParameter parameter : parameters) {
    std::copy_n(posture.block(parameter),
                block_size(parameter),
                predicted_.posture.block(parameter));
    predicted_.step.segment(column_of(parameter), tangent_size(parameter)).setZero();
    predicted_.covariance[index(parameter)] = restarted.covariance[index(parameter)];
    drift_.step.segment(column_of(parameter), tangent_size(parameter)).setZero();
  }
  PoseParameterProcess::to_prior(predicted_, prior_);
}

double TagFilter::unexplained(std::span<const SeenTag> seen, const Posture& posture) {
  fits_.resize(seen.size());
  solver_.fit(seen, inputs_, posture, fits_);
  const auto off = std::count_if(
      fits_.begin(), fits_.end(), [](const SightingFit& f) { return !is_used(f); });
  return static_cast<double>(off) /
         static_cast<double>(std::max<std::size_t>(1, fits_.size()));
}

/// Searches for parts that do not fit: the body if it is lost, or a limb that bends in
/// the wrong direction.
void TagFilter::repair(const Frame& frame, Posture& posture) {
  const std::span<const SeenTag> seen = frame.seen;
  const double since_s = frame.since_s;
  const double off = unexplained(seen, posture);
  const bool is_evaluated = seen.size() >= kMinSeenTags;
  if (is_evaluated)
    unexplained_s_ = off > 1.0 - kMaxExplainedSigmas ? unexplained_s_ + since_s : 0.0;
  until_next_search_s_ = std::max(0.0, until_next_search_s_ - since_s);
  if (until_next_search_s_ > 0.0) return;
  if (is_evaluated && (unexplained_s_ > 0.0 || (relocalize_ && off > 0.0))) {
    until_next_search_s_ = kSearchInterval_s;
    const auto found = relocalizer_.find(seen);
    if (!found) return;
    Posture other = *found;
    if (unexplained(seen, other) < off) {
      restart(other);
      prepare(frame.late_s);
      posture = other;
      (void)solver_.solve(seen, inputs_, posture, limits());
    }
    (void)unexplained(seen, posture);
    return;
  }
  for (std::size_t limb = 0; limb < kLimbParameters.size(); ++limb) {
    if (!relocalizer_.limb_misfits(limb, seen, fits_)) {
      limb_unexplained_s_[limb] = 0.0;
      continue;
    }
    limb_unexplained_s_[limb] += since_s;
    until_next_search_s_ = kSearchInterval_s;
    Posture other = posture;
    if (!relocalizer_.retry_limb(limb, seen, inputs_, limits(), other)) continue;
    const LimbParameters& s = kLimbParameters[limb];
    reset_parameters(
        std::array{s.frame, s.flexion, s.upper_twist, s.lower_twist, s.extremity}, other);
    posture = other;
    (void)solver_.solve(seen, inputs_, posture, limits());
    (void)unexplained(seen, posture);
    return;
  }
}

void TagFilter::step(std::span<const SeenTag> seen,
                     std::span<const double> late_s,
                     double since_s) {
  const Frame frame{seen, late_s, since_s};
  Posture posture;
  if (process_frame(frame, posture)) update_lags_and_slips(frame, posture);
}

/// Updates the cameras' lags and the tags' slip from the solved frame.
void TagFilter::update_lags_and_slips(const Frame& frame, const Posture& posture) {
  solver_.slips(frame.seen, inputs_, posture, covariance_, slip_scores_);
  if (lags_.any()) {
    solver_.lateness(frame.seen, inputs_, posture, limits(), lateness_);
    lags_.update(
        lateness_, solver_.late_factor(), 1.0 / process_.rate().hz, frame.since_s);
  }
  slips_.update(slip_scores_, frame.since_s);
}

}  // namespace marey::reconstruct
