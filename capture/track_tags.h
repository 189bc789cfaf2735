// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "capture/detect_tags.h"

namespace marey::capture {

struct TrackTagsOptions {
  TagDetectorOptions detector;
  /// The whole picture is searched this often, for tags that come in from its edges.
  int full_every_frames = 30;
  /// Into so many upright strips, one after the other, that search of the whole picture is
  /// spread, so that no frame takes much longer than others: what live work wants. 1: it
  /// is done at once. While fewer tags are seen than lately, or none, a sixth of the
  /// picture is searched in every frame.
  int strips = 1;
  /// The surroundings of all tags that are followed are searched this often, for those
  /// of the same body that turn into view. With strips in bands, one a frame.
  int body_every_frames = 2;
  /// A tag that is not found is looked for in its predicted place for so many frames.
  int remember_frames = 6;
};

/// How live work follows tags: every frame costs about the same, and the whole picture,
/// in strips, comes round in a second of 30 frames.
[[nodiscard]] TrackTagsOptions live_tracking();

/// What a frame's tags were looked for in.
enum class SearchKind {
  kFull,     ///< The whole picture.
  kBody,     ///< One box around all tags that are followed, and well beyond; or a band.
  kRegions,  ///< Merged boxes around the predicted tags.
  kStrip,    ///< A strip of the picture beside these.
};

/// Follows the tags of one camera from frame to frame: looks where they should be, which
/// takes a fraction of the time of looking everywhere, and now and then around them and
/// everywhere. Each tag's corners move at a constant velocity in the picture from its
/// last two sightings. Where the boxes together would cost as much as the whole picture,
/// that is searched.
///
/// Boxes are searched without decimation, so that corners are those of TagDetector (whose
/// threshold tiles they keep); the first frame is always searched whole. One thread at a
/// time. The past is in this object and nowhere else: the same frames in the same order
/// give the same tags.
class TagTracker {
 public:
  /// kBadInput as TagDetector::create(). Precondition: intervals and strips are positive,
  /// remember_frames not negative, quad_decimate is 1.
  [[nodiscard]] static Result<TagTracker> create(const TrackTagsOptions& options = {});

  /// Tags in `frame`, as TagDetector::detect() says, but for those that it has not come
  /// to look for yet. `frame.index` must grow from call to call; the size must not
  /// change. The result is valid until the next call. Allocates nothing of its own once
  /// it has seen as many tags before.
  [[nodiscard]] const std::vector<TagDetection>& track(const GrayFrame& frame);

  /// How the last frame was searched.
  [[nodiscard]] SearchKind last_search() const { return last_search_; }
  [[nodiscard]] const DroppedSightings& dropped() const { return detector_.dropped(); }

 private:
  struct Track {
    TagId id{};
    std::array<glm::dvec2, 4> corners_px{};
    glm::dvec2 velocity_px{0.0};  ///< Of its middle, per frame.
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
  int strip_ = 0;  ///< Whose turn it is.
  PixelBox strip_box_;
  int body_searches_ = 0;
  int band_ = 0;       ///< Whose turn it is.
  double usual_ = 0.0;  ///< Tags seen lately in a frame: the most of them, slowly forgotten.
  SearchKind last_search_ = SearchKind::kFull;
};

}  // namespace marey::capture
