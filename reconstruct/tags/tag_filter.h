// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: postures of successive frames, from tags.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "reconstruct/posture/posture_filter.h"
#include "reconstruct/tags/camera_lags.h"
#include "reconstruct/tags/planar_ambiguity.h"
#include "reconstruct/tags/relocalize_from_tags.h"
#include "reconstruct/tags/track_tag_slip.h"

namespace marey::reconstruct {

/// Tracks a body through frames of tags. Borrows the model.
class TagFilter : public PostureFilter<TagFilter, TagFrameSolver> {
 public:
  TagFilter(const TagModel& model, FrameRate rate, const std::vector<bool>& lag_known);
  // Not copyable: members point at each other.
  TagFilter(const TagFilter&) = delete;
  TagFilter& operator=(const TagFilter&) = delete;

  /// Processes a frame `since_s` after the previous one; camera c took its picture
  /// `late_s[c]` after the frame's instant. Does nothing while not started and the body
  /// is not found. Precondition: since_s positive.
  void step(std::span<const SeenTag> seen,
            std::span<const double> late_s,
            double since_s);

  /// Fit of the last step's sightings.
  [[nodiscard]] std::span<const SightingFit> fits() const { return fits_; }
  /// Returns whether a sighting with this fit is used.
  [[nodiscard]] static bool is_used(const SightingFit& fit);
  /// Returns for how long most sightings have not been explained. [s]
  [[nodiscard]] double unexplained_s() const { return unexplained_s_; }
  /// Requests a search without a prior in the next step that shows enough of the body.
  void relocalize() { relocalize_ = true; }

  [[nodiscard]] const CameraLags& lags() const { return lags_; }
  [[nodiscard]] const UnfoldedPosture& unfold(const Posture& posture) {
    return solver_.unfold(posture);
  }

 private:
  friend PostureFilter;
  struct Frame {
    std::span<const SeenTag> seen;
    std::span<const double> late_s;
    double since_s;
  };

  [[nodiscard]] std::optional<Posture> find(const Frame& frame);
  void restart(const Posture& posture);
  void predict(const Frame& frame);
  void prepare(std::span<const double> late_s);
  void solve(const Frame& frame, Posture& posture);
  void repair(const Frame& frame, Posture& posture);
  void reset_parameters(std::span<const PoseParameter> parameters,
                        const Posture& posture);
  void update_lags_and_slips(const Frame& frame, const Posture& posture);
  [[nodiscard]] double unexplained(std::span<const SeenTag> seen, const Posture& posture);

  const TagModel* model_;
  FrameRate nominal_;
  TagPoseRelocalizer relocalizer_;
  PlanarPoseAmbiguity ambiguity_;
  CameraLags lags_;
  Drift drift_;
  std::vector<double> late_frames_;
  std::vector<double> late_sigma_frames_;
  SlipTracker slips_;
  std::array<TagFrameSolver::SlipScore, kHumanBoneCount> slip_scores_{};
  TagFrameSolver::SolveInputs inputs_;
  std::vector<SightingFit> fits_;
  std::vector<TagFrameSolver::Lateness> lateness_;
  std::array<double, 4> limb_unexplained_s_{};
  double unexplained_s_ = 0.0;
  double until_next_search_s_ = 0.0;
  bool relocalize_ = false;
};

}  // namespace marey::reconstruct
