// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "capture/tags/detect_tags.h"

namespace marey::capture {

struct TrackTagsOptions {
  TagDetectorOptions detector;
  /// Interval of searches of the whole image, for tags that enter from its edges.
  int full_every_frames = 30;
  /// Number of upright strips over which the search of the whole image is spread, one
  /// strip per frame, so that all frames take about the same time (for live use). 1: the
  /// whole image at once. If fewer tags are seen than recently, or none, a sixth of the
  /// image is searched in every frame.
  int strips = 1;
  /// Interval of searches of the surroundings of all tracked tags, for tags of the same
  /// body that turn into view. With strips, the surroundings are divided into bands, one
  /// per frame.
  int body_every_frames = 2;
  /// Number of frames for which a missed tag is searched for at its predicted position.
  int remember_frames = 6;
};

/// Returns the options for live use: all frames have about the same cost, and the whole
/// image, in strips, is searched once per second at 30 frames/s.
[[nodiscard]] TrackTagsOptions live_tracking();

/// Part of the image that was searched for a frame's tags.
enum class SearchKind {
  kFull,     ///< The whole image.
  kBody,     ///< One box around all tracked tags with a wide margin; or a band of it.
  kRegions,  ///< Merged boxes around the predicted tags.
  kStrip,    ///< A strip of the image in addition to these.
};

/// Tracks the tags of one camera from frame to frame. Searches their predicted positions,
/// which takes a fraction of the time of a full search, and at intervals their
/// surroundings and the whole image. The prediction is a constant velocity of each tag's
/// corners in the image from its last two sightings. If the boxes together would cost as
/// much as the whole image, that is searched.
///
/// Boxes are searched without decimation. Corners therefore equal those of TagDetector
/// (boxes keep its threshold tiles). The first frame is always searched completely. One
/// thread at a time. All state is in this object: the same frames in the same order give
/// the same tags.
class TagTracker {
 public:
  /// Errors as for TagDetector::create(). Precondition: intervals and strips are
  /// positive, remember_frames is not negative, quad_decimate is 1.
  [[nodiscard]] static Result<TagTracker> create(const TrackTagsOptions& options = {});

  /// Returns the tags in `frame`, as TagDetector::detect(), except tags that were not
  /// searched for yet. `frame.index` must increase from call to call; the size must not
  /// change. The result is valid until the next call. Allocates nothing once the number
  /// of tags has been reached before.
  [[nodiscard]] const std::vector<TagDetection>& track(const GrayFrame& frame);

  /// Returns how the last frame was searched.
  [[nodiscard]] SearchKind last_search() const { return last_search_; }
  [[nodiscard]] const DroppedSightings& dropped() const { return detector_.dropped(); }

 private:
  struct Track {
    TagId id{};
    std::array<glm::dvec2, 4> corners_px{};
    glm::dvec2 velocity_px{0.0};  ///< Velocity of its middle, per frame.
    int last_frame = 0;
    int sightings = 0;
  };

  TagTracker(TagDetector detector, const TrackTagsOptions& options);
  [[nodiscard]] SearchKind choose_search(const GrayFrame& frame);
  [[nodiscard]] SearchKind choose_parts(const GrayFrame& frame, bool is_spread);
  void predict_boxes(const GrayFrame& frame);
  [[nodiscard]] SearchKind choose_spread(const GrayFrame& frame);
  void choose_body(const GrayFrame& frame);
  void choose_band(const GrayFrame& frame);
  void choose_strip(const GrayFrame& frame, int strips);
  void search_strip(const GrayFrame& frame);
  void merge_boxes();
  void remember(const GrayFrame& frame);

  TrackTagsOptions options_;
  TagDetector detector_;
  std::vector<Track> tracks_;  ///< Ascending ids.
  std::vector<Track> updated_;
  std::vector<PixelBox> boxes_;
  std::vector<TagDetection> found_;
  int next_full_ = 0;
  int next_body_ = 0;
  int next_strip_ = 0;
  int strip_ = 0;  ///< Index of the strip to search next.
  PixelBox strip_box_;
  int body_searches_ = 0;
  int band_ = 0;  ///< Index of the band to search next.
  double typical_tag_count_ =
      0.0;  ///< Recent maximum of the number of tags per frame, slowly decaying.
  SearchKind last_search_ = SearchKind::kFull;
};

}  // namespace marey::capture
