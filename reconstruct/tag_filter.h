// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: postures of one frame after the other, from tags.

#include <array>
#include <span>
#include <vector>

#include "reconstruct/camera_lags.h"
#include "reconstruct/find_tagged_posture.h"
#include "reconstruct/follow_slips.h"
#include "reconstruct/slot_filter.h"
#include "reconstruct/tag_readings.h"

namespace marey::reconstruct {

/// Follows a body through frames: each is solved from its tags and from what the frames
/// before make expect. Storage is fixed once it is made. Borrows the model.
class TagFilter {
 public:
  TagFilter(const TagModel& model, FrameRate rate, const std::vector<bool>& lag_known);
  // Its parts point at each other.
  TagFilter(const TagFilter&) = delete;
  TagFilter& operator=(const TagFilter&) = delete;

  /// A frame `since_s` after the one before, of which camera c took its picture
  /// `late_s[c]` after the frame's instant. Until started and where the body is not to be
  /// found, does nothing. Precondition: since_s positive.
  void step(std::span<const SeenTag> seen,
            std::span<const double> late_s,
            double since_s);

  [[nodiscard]] bool started() const { return started_; }
  /// Of the last step, after its tags. Precondition of these: started().
  [[nodiscard]] const PostureBelief& filtered() const { return filtered_; }
  [[nodiscard]] const PostureCovariance& covariance() const { return covariance_; }
  /// How the last step's sightings fit.
  [[nodiscard]] std::span<const TagFit> fits() const { return fits_; }
  /// Whether a sighting is believed that fits so.
  [[nodiscard]] static bool is_used(const TagFit& fit);
  /// For how long most of what was seen has not been explained. [s]
  [[nodiscard]] double astray_s() const { return astray_s_; }
  /// The body is looked for from nothing in the next step that shows enough of it.
  void look_anew() { look_anew_ = true; }

  [[nodiscard]] const CameraLags& lags() const { return lags_; }
  [[nodiscard]] const UnfoldedPosture& unfold(const Posture& posture) {
    return solver_.unfold(posture);
  }

 private:
  void start(const Posture& posture);
  void predict(double since_s);
  void prepare(std::span<const double> late_s);
  void refine(std::span<const SeenTag> seen, Posture& posture);
  void mend(std::span<const SeenTag> seen,
            std::span<const double> late_s,
            double since_s,
            Posture& posture);
  void forget(std::span<const Slot> slots, const Posture& posture);
  void learn(std::span<const SeenTag> seen, double since_s, const Posture& posture);
  [[nodiscard]] double unexplained(std::span<const SeenTag> seen, const Posture& posture);
  [[nodiscard]] TagLimits limits() const;

  const TagModel* model_;
  FrameRate nominal_;
  SlotProcess process_;
  TagFrameSolver solver_;
  TaggedPostureFinder finder_;
  TagReadings readings_;
  CameraLags lags_;
  PostureBelief predicted_;
  PostureBelief filtered_;
  PosturePrior prior_;
  Drift drift_;
  std::vector<double> late_frames_;
  std::vector<double> late_sigma_frames_;
  FollowedSlips slips_;
  std::array<TagFrameSolver::SlipScore, kHumanBoneCount> slip_scores_{};
  TagFrameSolver::Beside beside_;
  PostureCovariance covariance_;
  std::vector<TagFit> fits_;
  std::vector<TagFrameSolver::Lateness> lateness_;
  std::array<double, 4> limb_astray_s_{};
  double astray_s_ = 0.0;
  double until_next_look_s_ = 0.0;
  bool started_ = false;
  bool look_anew_ = false;
};

}  // namespace marey::reconstruct
