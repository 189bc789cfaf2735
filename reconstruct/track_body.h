// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/body.h"
#include "core/camera.h"
#include "core/detection.h"
#include "core/motion.h"
#include "core/result.h"

namespace marey::reconstruct {

/// What one camera contributes to a frame.
struct CameraView {
  /// Tags with shrinkage taken off (unshrunk()); empty where the camera has no picture.
  /// Ids that the body does not wear are ignored, as are corners that are not finite.
  std::span<const TagDetection> tags;
  /// How much later than the frame's instant this picture was taken. [s] May be negative.
  double late_s = 0.0;
};

enum class TrackState {
  kWaiting,  ///< The body was not found yet.
  kTracked,
  /// Hips and chest have not been seen for longer than `longest_repair_s`, or what is
  /// seen has made no sense for as long: the pose is a guess.
  kLost,
};

/// What is known of the last frame beside its pose.
struct TrackReport {
  TrackState state = TrackState::kWaiting;
  int tags_used = 0;     ///< Sightings over all cameras that the pose explains.
  int tags_doubted = 0;  ///< Of the body's, that it does not: misread, or another's.
  double rms_px = 0.0;   ///< Of used corners' distances to their model; 0 without any.
};

struct TrackBodyOptions {
  /// A segment unseen for longer than this is inferred, not repaired; hips and chest
  /// unseen for longer, and the body is lost. [s]
  double longest_repair_s = 1.0;
  /// How well cameras know where things are, per coordinate. [m]
  double camera_sigma_m = 0.0;
  /// Per camera whether CameraView::late_s is the whole truth; others are followed by
  /// the constant lag that they have beside it, which takes a second or two of movement.
  /// Where no camera is known, stamps are right on average: the lags' mean is zero.
  /// Cameras beyond the end are unknown, but for the first: its clock is the frames'.
  std::vector<bool> lag_known{};
};

/// solve_motion() of one frame after the other, as they come: live, without lag. Each
/// frame is solved from its own corners, from what the frames before make expect, and
/// from human habits (Levenberg-Marquardt with derivatives written out); each joint's
/// movement is an Ornstein-Uhlenbeck process, whose filter runs beside. Tags that do not
/// fit are doubted (Cauchy). Hands, feet and head that show a lone tag to one camera are
/// tried in both its readings, limbs that do not fit in all of theirs.
///
/// The past is in this object and nowhere else: the same calls give the same bytes. One
/// thread at a time.
class BodyTracker {
 public:
  /// kBadInput where the body wears no tag, or there is no camera. Precondition: rate
  /// above 0; `lag_known` no longer than `cameras`.
  [[nodiscard]] static Result<BodyTracker> create(const Body& body,
                                                  std::span<const Camera> cameras,
                                                  FrameRate rate,
                                                  const TrackBodyOptions& options = {});
  ~BodyTracker();
  BodyTracker(BodyTracker&&) noexcept;
  BodyTracker& operator=(BodyTracker&&) noexcept;

  /// One frame on, `since_last_s` after the last call's: 1 / rate, or a multiple where
  /// frames were dropped, or whatever the clock says. `views` has one entry per camera
  /// (a precondition); since_last_s is finite and above 0 (likewise).
  ///
  /// Fills `pose` (of skeleton()) and `doubt`, one entry per joint, and returns true;
  /// false while the body was not found yet. A joint is measured where a tag of its
  /// segment was used in this frame. Never a NaN. After the first call that returned true
  /// with the same `pose` and `doubt` it does not allocate.
  /// Cost: some 1.2 ms with four cameras; up to 20 ms in frames in which the body is
  /// looked for anew, at most seven in a second.
  [[nodiscard]] bool step(std::span<const CameraView> views,
                          double since_last_s,
                          Pose& pose,
                          std::vector<JointDoubt>& doubt);

  /// Of the last step().
  [[nodiscard]] const TrackReport& last() const;
  /// Per camera, what was found of its lag beside CameraView::late_s so far. [s]
  [[nodiscard]] std::span<const double> lags_s() const;
  [[nodiscard]] const Skeleton& skeleton() const;

 private:
  struct Inside;
  explicit BodyTracker(std::unique_ptr<Inside> inside);
  std::unique_ptr<Inside> inside_;
};

}  // namespace marey::reconstruct
