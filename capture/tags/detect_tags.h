// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "capture/video/frame_source.h"
#include "core/base/result.h"
#include "core/detection.h"
#include "core/tag_family.h"

namespace marey::capture {

struct TagDetectorOptions {
  /// By name: tag16h5, tag25h9, tag36h10, tag36h11, tag36h11b2 (Kalibr's boards: a frame
  /// of two black cells, squares at the corners; three times the cost), tagCircle21h7,
  /// tagCircle49h12, tagCustom48h12, tagStandard41h12 or tagStandard52h13. With several
  /// families, each lists its ids, and the lists are disjoint.
  std::vector<TagFamilyUse> families{{}};
  /// Detect squares in an image this many times smaller: 1 (finest), 1.5, 2, 3...
  double quad_decimate = 1.0;
  /// More than one thread gains nothing within an image; use one detector per camera.
  int threads = 1;
  int max_hamming = 1;  ///< Corrected bit errors per tag, 0 to 2.
  /// libapriltag's decision margin (contrast of the bits); lower sightings are dropped.
  double min_decision_margin = 20.0;
  bool refine_edges = true;  ///< Fit each edge to the grey values around it.
  /// Then fit the whole pattern of each tag to the image (capture/tags/align_pattern.h).
  /// Corners are two to three times more accurate and without shrinkage, for about 1 ms a
  /// tag.
  bool align_patterns = true;
};

/// Pixels from `left` and `top` on, up to but excluding `right` and `bottom`.
struct PixelBox {
  int left = 0;
  int top = 0;
  int right = 0;
  int bottom = 0;
};

/// Detects tags in images. Owns libapriltag's detector and its buffers; one thread at a
/// time may use it.
class TagDetector {
 public:
  /// Errors (kBadInput): an option is out of range, such as an unknown family or an id
  /// that two families share.
  [[nodiscard]] static Result<TagDetector> create(const TagDetectorOptions& options = {});

  TagDetector(TagDetector&&) noexcept;
  TagDetector& operator=(TagDetector&&) noexcept;
  ~TagDetector();

  /// Returns the tags in `frame`, ids ascending, each id once; none for an image too
  /// small for a tag. sigma_px is from the fit of the tag's pattern
  /// (capture/tags/align_pattern.h): it increases with lower contrast, more blur and any
  /// other deviation from the pattern. It is edge_corner_sigma_px() if the options
  /// disable the fit, the same plus 0.3 px of shrinkage if the fit failed, and twice that
  /// if a bit of the code was corrected. Stateless except for the counts in dropped():
  /// equal images give equal results. Cost: about 24 ms at 1280x720 and 1 ms for each
  /// tag.
  [[nodiscard]] std::vector<TagDetection> detect(const GrayFrame& frame);

  /// First part of detect(), for callers with known search areas: appends the sightings
  /// in `box`, in the order of detection. A box that is too small for a tag gives none.
  /// Precondition: `box` is inside the frame.
  void search(const GrayFrame& frame,
              const PixelBox& box,
              std::vector<TagDetection>& found);
  /// Completes search(): sorts the sightings of all boxes, drops duplicate ids, aligns
  /// the rest. Allocates nothing for tags that were detected before.
  void finish(const GrayFrame& frame, std::vector<TagDetection>& found);

  /// Returns counts of dropped sightings since the construction.
  [[nodiscard]] const DroppedSightings& dropped() const;

 private:
  struct Impl;
  explicit TagDetector(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace marey::capture
