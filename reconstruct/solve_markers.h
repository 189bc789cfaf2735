// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/body.h"
#include "core/marker_tracks.h"
#include "core/motion.h"
#include "core/progress.h"

namespace marey::reconstruct {

/// How a marker of the body agrees with the solved motion.
struct MarkerFit {
  double rms_m = 0.0;    ///< Of its distances to where it should be.
  double worst_m = 0.0;  ///< The largest.
  int frames = 0;        ///< In which it was measured.
};

struct SolvedMarkers {
  EstimatedMotion estimate;
  std::vector<MarkerFit> markers;   ///< In the order of body.markers.
  std::vector<double> frame_rms_m;  ///< Per frame; 0 where nothing was measured.
  double rms_m = 0.0;               ///< Over all markers of all frames alike.
  /// Where the model has every marker of body.markers, frame by frame. [m]
  std::vector<glm::dvec3> modelled_in_world;
  /// Frames in which the hips or the chest were measured, or bridged.
  int frames_solved = 0;
};

struct SolveMarkersOptions {
  /// A segment without markers for longer than this is inferred, not repaired. [s]
  double longest_repair_s = 1.0;
};

/// Fits the normalized skeleton of a known body to labelled markers, every frame of a
/// trial: frames one after the other from what went before, then back again, so that each
/// is solved from its own markers and from all other frames. What frames say of each
/// other is an Ornstein-Uhlenbeck process per joint; markers that are far off are doubted
/// (Cauchy), joints are kept within human habits by soft terms. Repaired samples count as
/// far as their sigma lets them; samples that are not finite, not at all.
///
/// Markers are found by their labels; those the body does not know are left aside.
/// nullopt where no frame shows six or more. Deterministic. Cost: some 0.25 ms a frame
/// with 50 markers; memory beyond the result, some 10 MB at
/// 100 frames a second, grows with the rate and not with the trial. Precondition:
/// rate above 0.
[[nodiscard]] std::optional<SolvedMarkers> solve_markers(
    const Body& body,
    const MarkerTracks& tracks,
    const SolveMarkersOptions& options = {},
    const Progress& progress = {});

/// solve_markers() of one frame after the other, as they come: live.
class MarkerTracker {
 public:
  /// `labels` say which marker is which in the frames to come.
  MarkerTracker(const Body& body, std::span<const std::string> labels, FrameRate rate);
  ~MarkerTracker();
  MarkerTracker(MarkerTracker&&) noexcept;
  MarkerTracker& operator=(MarkerTracker&&) noexcept;

  /// One frame on: `frame` has one entry per label (a precondition); samples that are not
  /// finite are taken for not seen. Fills `pose` (of skeleton()) and
  /// `doubt`, one entry per joint, and returns true; false as long as no frame had six
  /// markers. The same bytes as any other run over the same frames. After the first call
  /// that returned true with the same `pose` and `doubt` it does not allocate.
  /// Cost: some 0.2 ms with 50 markers; where the body was lost, some 20 ms once.
  [[nodiscard]] bool step(std::span<const std::optional<MarkerSample>> frame,
                          Pose& pose,
                          std::vector<JointDoubt>& doubt);

  [[nodiscard]] const Skeleton& skeleton() const;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace marey::reconstruct
