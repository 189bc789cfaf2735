// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/body.h"
#include "core/camera.h"
#include "core/detection.h"
#include "core/motion.h"
#include "reconstruct/posture/measured_sigma.h"

namespace marey::reconstruct {

struct SolveMotionOptions {
  /// Frames solved at once, and how many of them the next window solves again. Memory and
  /// the cost per frame depend on the window, not on the trial.
  int window_frames = 90;
  int overlap_frames = 30;
  /// A segment unseen for longer than this is inferred, not repaired. [s]
  double max_repair_s = 1.0;
  /// Standard deviation of points measured by the cameras, per coordinate, due to their
  /// calibration. [m] The cameras' common error is not visible in the residuals of their
  /// tags.
  double camera_sigma_m = 0.0;
  /// Estimate the time offsets of cameras without a given offset. The first camera's
  /// clock is the trial's.
  bool estimate_offsets = true;
};

/// A run of frames in which no tag of a segment was seen.
struct Gap {
  HumanBone segment{};
  int first_frame = 0;
  int last_frame = 0;  ///< Inclusive.
  Source bridged_as = Source::kRepaired;
};

/// Reprojection error of the solved motion in one camera.
struct CameraFit {
  double rms_px = 0.0;
  double median_px = 0.0;
  int corners = 0;
  double offset_s = 0.0;  ///< Frame k was exposed at k / rate + offset_s.
  ClockSource clock = ClockSource::kEstimated;
};

/// Reprojection error of one tag of the body, over all cameras and frames.
struct TagFit {
  TagId id{};
  double rms_px = 0.0;
  double median_px = 0.0;
  int corners = 0;
};

/// Uncertainty of one tag of the body in one frame.
struct TagUncertainty {
  /// Standard deviation of its centre, per coordinate, including its slip on the segment.
  /// [m]
  float sigma_m = 0.0F;
  std::uint8_t cameras = 0;  ///< Bit i: camera i saw it; first seven cameras only.
  bool seen = false;         ///< By any camera.
};

struct SolvedTrial {
  EstimatedMotion estimate;
  std::vector<std::vector<TagUncertainty>> tags;  ///< [frame][tag of the body]
  std::vector<CameraFit> cameras;
  std::vector<TagFit> tag_fits;      ///< In the order of the body's tags.
  std::vector<double> frame_rms_px;  ///< Per frame; 0 if no tag was seen.
  std::vector<int> tags_seen;        ///< Per frame: sightings over all cameras.
  std::vector<Gap> gaps;             ///< By segment, then frame. Tagged segments only.
  double rms_px = 0.0;
  double median_px = 0.0;
  /// Frames whose hips or chest were seen, or bridged within `max_repair_s`.
  int frames_solved = 0;
};

/// Returns the part of a joint's sigma in a motion that comes from the body. [m]
[[nodiscard]] double centre_sigma_in_motion_m(const Body& body, HumanBone joint);

/// Fits the normalized skeleton to every frame of a trial: all seen corners in all
/// cameras at once, with a temporal term that bridges unseen segments.
/// First each frame alone, starting from the previous one and from the tags' own poses;
/// then overlapping windows in which all frames are free (Ceres, sparse). The slip of
/// each segment's tags is estimated from their residuals (soft_tissue_noise.h), and the
/// windows are solved with it. Joint sigmas combine the windows' covariance, the body's
/// sigmas (elbows 0.8 of it, wrists and ankles 0.85, knees 1.1, hips 1.15), the planar
/// ambiguity of tags, the cameras and their clocks. If one camera alone sees tags of both
/// segments at an elbow or knee, half of the shoulder's or hip's sigma is added. Limb
/// joints above kMaxMeasuredSigma_m are kInferred.
/// `detections` holds one entry per camera of `cameras`, in order; an entry with an
/// offset keeps it. Deterministic. Errors (kBadInput, `where` is the first video): no
/// body tag is seen in any frame; the body is never found in the trial; no motion
/// explains the tags. Cost: about 60 ms per frame and core. Memory grows only by the
/// poses.
[[nodiscard]] Result<SolvedTrial> solve_motion(
    const Body& body,
    std::span<const Camera> cameras,
    std::span<const CameraDetections> detections,
    const SolveMotionOptions& options = {},
    const Progress& progress = {});

}  // namespace marey::reconstruct
