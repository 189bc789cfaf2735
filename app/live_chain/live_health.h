// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/live_chain/live_figures.h"
#include "core/body.h"
#include "core/live_instant.h"
#include "core/motion.h"
#include "live/page/page_status.h"

namespace marey::app {

/// How a camera fares, as the page tells it: `before` is what was told of it last, or
/// null. A camera streams whose pictures have come since; of one whose pictures have not,
/// its own trouble says whether it is lost.
[[nodiscard]] live::PageCameraStatus camera_status(const LiveCameraFigures& now,
                                                   const LiveCameraFigures* before,
                                                   int tags);

/// How an output fares, likewise: trouble counts while there is some, not for ever.
[[nodiscard]] live::PageOutput output_status(const OutputCounts& now,
                                             const OutputCounts* before);

/// The segments of a body that wear tags.
class WornSegments {
 public:
  WornSegments() = default;
  explicit WornSegments(const Body& body);
  /// Names of those of which no tag was seen for longer than a tracker bridges: their
  /// place is a guess. `uncertainty` is of the body's joints, in the order of HumanBone.
  [[nodiscard]] std::vector<std::string> unseen(
      std::span<const JointUncertainty> uncertainty) const;

 private:
  std::vector<HumanBone> bones_;  ///< Ascending.
};

/// Adds to a page's status how the body fares. It is tracked only where the worst camera
/// and the worst segment are well: every camera streams and `unseen` is empty. Else
/// PageStatus::warnings says what is not. Precondition: `status` has its cameras.
void add_subject_status(reconstruct::TrackState state,
                        const LiveFigures& figures,
                        const std::vector<std::string>& unseen,
                        live::PageStatus& status);

/// Whether a body's tags are seen in vain: for kAfter_s at least two cameras have seen
/// some of them each, and no body was found in them, or only one that is kMax_px beside
/// them. So it is when cameras were swapped or moved since they were calibrated.
class UnmatchedTagsDetector {
 public:
  static constexpr double kAfter_s = 3.0;
  static constexpr double kMax_px = 4.0;
  static constexpr int kMinTags = 4;  ///< Tags, of each of two cameras.

  explicit UnmatchedTagsDetector(const Body& body);
  void add(const LiveInstant& instant, const reconstruct::TrackReport& found);
  [[nodiscard]] bool has_unmatched() const { return has_unmatched_; }
  /// What that means for who is there.
  static constexpr const char* kText =
      "tags are seen, but no body fits them: hips and chest are hidden, cameras were "
      "moved "
      "or swapped since they were calibrated, or it is another's suit. Next: show them, "
      "give each camera its name of then, or calibrate again.";

 private:
  std::vector<TagId> worn_;  ///< Ascending.
  std::optional<Timestamp> since_;
  bool has_unmatched_ = false;
};

}  // namespace marey::app
