// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/body.h"
#include "core/marker_tracks.h"
#include "core/motion.h"

namespace marey::reconstruct {

/// Agreement of a marker of the body with the solved motion.
struct MarkerFit {
  double rms_m = 0.0;    ///< Root mean square distance from its expected place.
  double worst_m = 0.0;  ///< The largest distance.
  int frames = 0;        ///< Frames in which it was measured.
};

struct SolvedMarkers {
  EstimatedMotion estimate;
  std::vector<MarkerFit> markers;   ///< In the order of body.markers.
  std::vector<double> frame_rms_m;  ///< Per frame; 0 if nothing was measured.
  double rms_m = 0.0;               ///< Over all markers of all frames.
  /// Expected place of every marker of body.markers, frame by frame. [m]
  std::vector<glm::dvec3> modelled_in_world;
  /// Frames in which the hips or the chest were measured, or bridged.
  int frames_solved = 0;
};

struct SolveMarkersOptions {
  /// A segment without markers for longer than this is inferred, not repaired. [s]
  double max_repair_s = 1.0;
};

/// Fits the normalized skeleton of a known body to labelled markers, every frame of a
/// trial, by a forward filter and a backward smoother, so that each frame is solved from
/// its own markers and from all other frames. Frames are coupled by an Ornstein-Uhlenbeck
/// process per joint; outlier markers are weighted down (Cauchy loss); pose priors are
/// soft terms. Repaired samples are weighted by their sigma; samples that are not finite
/// are ignored.
/// Markers are identified by their labels; labels that the body does not have are
/// ignored. nullopt if no frame shows six or more. Deterministic. Cost: some 0.25 ms per
/// frame with 50 markers; memory in addition to the result, some 10 MB at 100 frames per
/// second, grows with the rate and not with the trial. Precondition: rate above 0.
[[nodiscard]] std::optional<SolvedMarkers> solve_markers(
    const Body& body,
    const MarkerTracks& tracks,
    const SolveMarkersOptions& options = {},
    const Progress& progress = {});

/// Live counterpart of solve_markers(): solves successive frames.
class MarkerTracker {
 public:
  /// `labels` are those of the markers in the frames that follow, in order.
  MarkerTracker(const Body& body, std::span<const std::string> labels, FrameRate rate);
  ~MarkerTracker();
  MarkerTracker(MarkerTracker&&) noexcept;
  MarkerTracker& operator=(MarkerTracker&&) noexcept;

  /// Processes one frame. Precondition: `frame` has one entry per label; samples that are
  /// not finite count as not seen. Fills `pose` (of skeleton()) and `uncertainty`, one
  /// entry per joint, and returns true; false until a frame has six markers. Gives the
  /// same bytes as any other run over the same frames. After the first call that returned
  /// true with the same `pose` and `uncertainty` it does not allocate. Cost: some 0.2 ms
  /// with 50 markers; if the body was lost, some 20 ms once.
  [[nodiscard]] bool step(std::span<const std::optional<MarkerSample>> frame,
                          Pose& pose,
                          std::vector<JointUncertainty>& uncertainty);

  [[nodiscard]] const Skeleton& skeleton() const;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace marey::reconstruct
