// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/body.h"
#include "core/camera.h"
#include "core/detection.h"
#include "core/motion.h"

namespace marey::reconstruct {

/// The data of one camera in a frame.
struct CameraView {
  /// Detected tags, with shrinkage removed (unshrunk()); empty if the camera has no
  /// picture. Ids that the body does not wear are ignored, as are corners that are not
  /// finite.
  std::span<const TagDetection> tags;
  /// Delay of this picture after the frame's instant. [s] May be negative.
  double late_s = 0.0;
};

enum class TrackState {
  kWaiting,  ///< The body is not found yet.
  kTracked,
  /// Hips and chest have not been seen, or no posture has explained the sightings, for
  /// longer than `max_repair_s`: the pose is extrapolated.
  kLost,
};

/// Report on the last frame, in addition to its pose.
struct TrackReport {
  TrackState state = TrackState::kWaiting;
  int tags_used = 0;      ///< Sightings over all cameras that the pose explains.
  int tags_rejected = 0;  ///< Sightings of the body's tags that the pose does not
                          ///< explain: misread, or another person's.
  double rms_px = 0.0;    ///< Root mean square distance of used corners to their model; 0
                          ///< without any.
};

struct TrackBodyOptions {
  /// A segment unseen for longer than this is inferred, not repaired. If hips and chest
  /// are unseen for longer, the body is lost. [s]
  double max_repair_s = 1.0;
  /// Standard deviation of points measured by the cameras, per coordinate, due to their
  /// calibration. [m]
  double camera_sigma_m = 0.0;
  /// Per camera: true if CameraView::late_s includes all of its delay. For other cameras
  /// the remaining constant lag is estimated, which takes one or two seconds of movement.
  /// If no camera is known, stamps are right on average: the mean of the lags is zero.
  /// Cameras beyond the end are unknown, except the first: its clock is the frames'.
  std::vector<bool> lag_known{};
};

/// Live counterpart of solve_motion(): tracks a body frame by frame, without lag. Each
/// frame is solved from its own corners, from the prediction of the earlier frames, and
/// from human pose priors (Levenberg-Marquardt with analytic derivatives). Each joint's
/// movement is an Ornstein-Uhlenbeck process with a Kalman filter. Tags that do not fit
/// are weighted down (Cauchy loss). For hands, feet and head that show a single tag to
/// one camera both planar poses are tried; for limbs that do not fit, all planar poses of
/// their tags.
/// All state is in this object: the same calls give the same bytes. One thread at a time.
class BodyTracker {
 public:
  /// Creates a tracker. kBadInput if the body wears no tag, or if there is no camera.
  /// Precondition: rate above 0; `lag_known` no longer than `cameras`.
  [[nodiscard]] static Result<BodyTracker> create(const Body& body,
                                                  std::span<const Camera> cameras,
                                                  FrameRate rate,
                                                  const TrackBodyOptions& options = {});
  ~BodyTracker();
  BodyTracker(BodyTracker&&) noexcept;
  BodyTracker& operator=(BodyTracker&&) noexcept;

  /// Processes one frame, `since_last_s` after the last call's: 1 / rate, a multiple if
  /// frames were dropped, or the measured time. Preconditions: `views` has one entry per
  /// camera; since_last_s is finite and above 0.
  /// Fills `pose` (of skeleton()) and `uncertainty`, one entry per joint, and returns
  /// true; false while the body is not found yet. A joint is measured if a tag of its
  /// segment was used in this frame. No value is NaN. After the first call that returned
  /// true with the same `pose` and `uncertainty`, no call allocates. Cost: some 1.2 ms
  /// with four cameras; up to 20 ms in frames with a search without a prior, at most
  /// seven per second.
  [[nodiscard]] bool step(std::span<const CameraView> views,
                          double since_last_s,
                          Pose& pose,
                          std::vector<JointUncertainty>& uncertainty);

  /// Report on the last step().
  [[nodiscard]] const TrackReport& last() const;
  /// Per camera, the estimated lag in addition to CameraView::late_s. [s]
  [[nodiscard]] std::span<const double> lags_s() const;
  [[nodiscard]] const Skeleton& skeleton() const;

 private:
  struct Inside;
  explicit BodyTracker(std::unique_ptr<Inside> inside);
  std::unique_ptr<Inside> inside_;
};

}  // namespace marey::reconstruct
