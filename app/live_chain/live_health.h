// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/live_chain/live_statistics.h"
#include "core/body.h"
#include "core/live_instant.h"
#include "core/motion.h"
#include "live/page/page_status.h"

namespace marey::app {

/// Returns the status of a camera for the page. `before` is its previous state, or null.
/// A camera with new pictures since then is streaming; without new pictures, its own
/// health state decides if it is lost.
[[nodiscard]] live::PageCameraStatus camera_status(const LiveCameraFigures& now,
                                                   const LiveCameraFigures* before,
                                                   int tags);

/// Returns the status of an output for the page. `before` is its previous state, or null.
/// Only errors since then count.
[[nodiscard]] live::PageOutput output_status(const OutputCounts& now,
                                             const OutputCounts* before);

/// The segments of a body that carry tags.
class WornSegments {
 public:
  WornSegments() = default;
  explicit WornSegments(const Body& body);
  /// Returns the names of the segments without a visible tag for longer than the tracker
  /// bridges; their pose is inferred. `uncertainty` is that of the body's joints, in the
  /// order of HumanBone.
  [[nodiscard]] std::vector<std::string> unseen(
      std::span<const JointUncertainty> uncertainty) const;

 private:
  std::vector<HumanBone> bones_;  ///< Ascending.
};

/// Adds the subject's status to a page's status. The subject is "tracked" only if every
/// camera is streaming and `unseen` is empty; otherwise PageStatus::warnings names the
/// cameras and segments. Precondition: `status` has its cameras.
void add_subject_status(reconstruct::TrackState state,
                        const LiveStatistics& figures,
                        const std::vector<std::string>& unseen,
                        live::PageStatus& status);

/// Detects that tags are visible but no body pose fits them: for kAfter_s at least two
/// cameras have each seen kMinTags of the body's tags, and no body was found, or only one
/// with a residual above kMax_px. The typical cause is cameras that were exchanged or
/// moved since their calibration.
class UnmatchedTagsDetector {
 public:
  static constexpr double kAfter_s = 3.0;
  static constexpr double kMax_px = 4.0;
  static constexpr int kMinTags = 4;  ///< In each of two cameras.

  explicit UnmatchedTagsDetector(const Body& body);
  void add(const LiveInstant& instant, const reconstruct::TrackReport& found);
  [[nodiscard]] bool has_unmatched() const { return has_unmatched_; }
  /// Message to the user.
  static constexpr const char* kText =
      "Tags are visible but no body pose fits them. Possible causes: hips and chest are "
      "hidden; cameras were moved or exchanged since the calibration; the suit belongs "
      "to "
      "another subject. Next: show hips and chest, restore the camera names of the "
      "calibration, or calibrate again.";

 private:
  std::vector<TagId> worn_;  ///< Ascending.
  std::optional<Timestamp> since_;
  bool has_unmatched_ = false;
};

}  // namespace marey::app
