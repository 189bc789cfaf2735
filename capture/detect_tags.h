// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "capture/frame_source.h"
#include "core/detection.h"
#include "core/result.h"
#include "core/tag_family.h"

namespace marey::capture {

struct TagDetectorOptions {
  /// By name: tag16h5, tag25h9, tag36h10, tag36h11, tag36h11b2 (Kalibr's boards: a frame
  /// of two black cells, squares at the corners; three times the work), tagCircle21h7,
  /// tagCircle49h12, tagCustom48h12, tagStandard41h12 or tagStandard52h13. Of several
  /// families, each lists its ids, and none is in two lists.
  std::vector<TagFamilyUse> families{{}};
  /// Look for squares in an image this many times smaller: 1 (finest), 1.5, 2, 3...
  double quad_decimate = 1.0;
  /// More than one gains nothing within an image: give each camera a detector instead.
  int threads = 1;
  int max_hamming = 1;  ///< Wrong bits forgiven in a tag, 0 to 2.
  /// libapriltag's measure of contrast against doubt; below it sightings are dropped.
  double min_decision_margin = 20.0;
  bool refine_edges = true;  ///< Fit each edge to the grey values around it.
  /// Fit then the whole pattern of each tag to the image (capture/align_pattern.h).
  /// Corners are two to three times better for about 1 ms a tag, and no longer drawn
  /// inward.
  bool align_patterns = true;
};

/// Pixels from `left` and `top` on, up to but without `right` and `bottom`.
struct PixelBox {
  int left = 0;
  int top = 0;
  int right = 0;
  int bottom = 0;
};

/// Finds tags in images. Owns libapriltag's detector and its buffers; one
/// thread at a time may use it.
class TagDetector {
 public:
  /// kBadInput when an option is out of its range, such as a family that is not known, or
  /// an id that two families share.
  [[nodiscard]] static Result<TagDetector> create(const TagDetectorOptions& options = {});

  TagDetector(TagDetector&&) noexcept;
  TagDetector& operator=(TagDetector&&) noexcept;
  ~TagDetector();

  /// Tags in `frame`, ids ascending, each id once. An image too small to hold a tag has
  /// none. sigma_px is what the fit of the tag's pattern says (capture/align_pattern.h):
  /// more for less contrast, more blur and whatever else does not look like the tag. It
  /// is edge_corner_sigma_px() where options ask for no such fit, and that with 0.3 px of
  /// shrinkage where the fit failed; twice that where a bit of its code was corrected.
  /// Same image, same answer: nothing is remembered but the counts in dropped(). About 24
  /// ms at 1280x720 and 1 ms for each tag.
  [[nodiscard]] std::vector<TagDetection> detect(const GrayFrame& frame);

  /// detect() in parts, for who knows where to look: appends the sightings in `box`,
  /// which must lie in the frame, as they come. A box that is too small to hold a tag has
  /// none.
  void search(const GrayFrame& frame,
              const PixelBox& box,
              std::vector<TagDetection>& found);
  /// Ends what search() began: orders the sightings of all boxes, drops ids that are
  /// there twice, aligns the rest. Allocates nothing for tags that it has met before.
  void finish(const GrayFrame& frame, std::vector<TagDetection>& found);

  /// What detect() dropped since this detector was made.
  [[nodiscard]] const DroppedSightings& dropped() const;

 private:
  struct Impl;
  explicit TagDetector(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Standard deviation of one corner coordinate found by libapriltag's search along the
/// edges, for a tag whose black square has a mean side of `side_px`. It is that of what
/// is left after the common shrinkage (TagShrinkage) is taken off, which it does not
/// cover. Precondition: side_px > 0.
[[nodiscard]] double edge_corner_sigma_px(double side_px);

/// The same for a corner whose tag's pattern was aligned, as far as its size tells: what
/// to expect of a picture that is not taken yet. Precondition: side_px > 0.
[[nodiscard]] double expected_corner_sigma_px(double side_px);

}  // namespace marey::capture
