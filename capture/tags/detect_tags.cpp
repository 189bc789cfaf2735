// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/tags/detect_tags.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include <apriltag/apriltag.h>
#include <glm/geometric.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "capture/tags/align_pattern.h"
#include "capture/tags/corner_sigma.h"
#include "capture/tags/tag_families.h"

namespace marey::capture {
namespace {

std::optional<Error> refusal_of_families(const std::vector<TagFamilyUse>& families) {
  std::set<TagId> taken;
  for (const TagFamilyUse& use : families) {
    if (!find_family(use.name)) return unknown_family(use.name);
    const bool shared = std::any_of(use.ids.begin(), use.ids.end(), [&](TagId id) {
      return !taken.insert(id).second;
    });
    if (!shared && (families.size() == 1 || !use.ids.empty())) continue;
    return bad_input("tag family",
                     "\"" + use.name + "\" shares ids with another family",
                     "give every tag an id of its own, whatever its family");
  }
  if (!families.empty()) return std::nullopt;
  return bad_input("tag family", "none is given", "use tag36h11");
}

std::optional<Error> refusal(const TagDetectorOptions& options) {
  if (auto error = refusal_of_families(options.families)) return error;
  if (!(options.quad_decimate >= 1.0 && options.quad_decimate <= 16.0)) {
    return bad_input("tag detector",
                     "quad_decimate must be from 1 to 16",
                     "use 1 for the finest corners, 2 for speed");
  }
  if (options.max_hamming < 0 || options.max_hamming > 2) {
    return bad_input("tag detector",
                     "max_hamming must be 0, 1 or 2",
                     "use 1; with more, noise is detected as tags");
  }
  if (options.threads < 1) {
    return bad_input("tag detector", "threads must be at least 1", "use 1");
  }
  return std::nullopt;
}

// A corrected code may be of another tag, or of a half hidden tag: its weight is a
// quarter.
constexpr double kCorrectedSigmaFactor = 2.0;

double mean_side_px(const std::array<glm::dvec2, 4>& corners_px) {
  double sum = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    sum += glm::distance(corners_px[i], corners_px[(i + 1) % 4]);
  }
  return 0.25 * sum;
}

/// `origin_px` is the origin of the searched part of the image.
TagDetection to_detection(const apriltag_detection_t& found,
                          const glm::dvec2& origin_px) {
  TagDetection tag;
  tag.id = TagId{found.id};
  for (std::size_t i = 0; i < 4; ++i) {
    // libapriltag's first pixel has its centre at 0.5, ours at 0.
    tag.corners_px[i] = origin_px + glm::dvec2(found.p[i][0] - 0.5, found.p[i][1] - 0.5);
  }
  tag.sigma_px = edge_corner_sigma_px(mean_side_px(tag.corners_px));
  tag.decision_margin = static_cast<double>(found.decision_margin);
  tag.hamming = found.hamming;
  return tag;
}

/// Sorts by id. For duplicate ids, keeps the one sighting without corrected bits, or
/// none: a corrected code may be of another tag. Returns the number of removed sightings.
int keep_unique_ids(std::vector<TagDetection>& tags) {
  std::sort(tags.begin(), tags.end(), [](const auto& a, const auto& b) {
    return std::pair(number(a.id), a.hamming) < std::pair(number(b.id), b.hamming);
  });
  std::size_t kept = 0;
  for (std::size_t first = 0; first < tags.size();) {
    std::size_t last = first + 1;
    while (last < tags.size() && tags[last].id == tags[first].id) ++last;
    const bool sole = last == first + 1;
    if (sole || (tags[first].hamming == 0 && tags[first + 1].hamming > 0)) {
      tags[kept++] = tags[first];
    }
    first = last;
  }
  const auto dropped = static_cast<int>(tags.size() - kept);
  tags.resize(kept);
  return dropped;
}

}  // namespace

struct TagDetector::Impl {
  explicit Impl(const TagDetectorOptions& options)
      : detector(apriltag_detector_create()),
        min_decision_margin(options.min_decision_margin),
        align_patterns(options.align_patterns) {
    for (const TagFamilyUse& use : options.families) {
      const FamilyMaker& family = *find_family(use.name);
      codes.push_back({&family, family.create(), {use.ids.begin(), use.ids.end()}});
      on_kalibr_board |= use.name == "tag36h11b2";
      apriltag_detector_add_family_bits(
          detector, codes.back().codes, options.max_hamming);
    }
    detector->nthreads = options.threads;
    detector->quad_decimate = static_cast<float>(options.quad_decimate);
    detector->quad_sigma = 0.0F;  // Other values would write into the caller's image.
    detector->refine_edges = options.refine_edges;
    detector->debug = false;
    // The margin is about half the difference between a tag's white and black; a certain
    // tag has twice this contrast. Weaker edges are mostly sensor noise: on noisy 720p
    // video, ignoring them reduced the time per frame from 69 ms to 24 ms and lost no
    // tag.
    detector->qtp.min_white_black_diff =
        std::clamp(static_cast<int>(options.min_decision_margin), 5, 20);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    apriltag_detector_destroy(detector);
    for (const Codes& one : codes) one.family->destroy(one.codes);
  }

  /// Appends libapriltag's detections in an image that begins at `origin_px` of the
  /// frame.
  void find(image_u8_t& image,
            const glm::dvec2& origin_px,
            std::vector<TagDetection>& found);
  void find_on_kalibr_board(const image_u8_t& image,
                            const glm::dvec2& origin_px,
                            std::vector<TagDetection>& found);

  /// Returns true if the sighting is of a tag in use.
  [[nodiscard]] bool in_use(const apriltag_detection_t& sighting) const {
    for (const Codes& one : codes) {
      if (one.codes != sighting.family) continue;
      return one.ids.empty() || one.ids.contains(TagId{sighting.id});
    }
    return false;
  }

  [[nodiscard]] apriltag_family_t* family_of(TagId id) const {
    for (const Codes& one : codes) {
      if (one.ids.empty() || one.ids.contains(id)) return one.codes;
    }
    return codes.front().codes;
  }

  void align(const GrayFrame& frame, TagDetection& tag);

  struct Codes {
    const FamilyMaker* family = nullptr;
    apriltag_family_t* codes = nullptr;  ///< Owned.
    std::set<TagId> ids;                 ///< Empty: all.
  };
  std::vector<Codes> codes;
  apriltag_detector_t* detector;
  bool on_kalibr_board = false;  ///< One of the families has Kalibr's frame.
  std::vector<std::uint8_t> copy;
  std::vector<TagDetection> again;
  double min_decision_margin;
  bool align_patterns;
  std::map<TagId, TagPattern> patterns;  ///< Patterns of the tags seen so far.
  AlignScratch scratch;
  DroppedSightings dropped;
};

void TagDetector::Impl::align(const GrayFrame& frame, TagDetection& tag) {
  auto known = patterns.find(tag.id);
  if (known == patterns.end()) {
    known = patterns.emplace(tag.id, pattern_of(family_of(tag.id), tag.id)).first;
  }
  constexpr double kSigmas = 4.0;
  constexpr double kKalibrPx = 1.5;  // White was dilated by a pixel.
  const double slack_px = 0.5 + kSigmas * tag.sigma_px +
                          static_cast<double>(detector->quad_decimate) - 1.0 +
                          (on_kalibr_board ? kKalibrPx : 0.0);
  const auto aligned =
      align_pattern(frame, known->second, tag.corners_px, slack_px, scratch);
  if (!aligned) {
    // The shrinkage of this tag is not corrected among aligned tags.
    constexpr double kShrinkagePx = 0.3;
    tag.sigma_px = std::hypot(tag.sigma_px, kShrinkagePx);
    return;
  }
  tag.corners_px = aligned->corners_px;
  tag.sigma_px = aligned->sigma_px;
}

void TagDetector::Impl::find(image_u8_t& image,
                             const glm::dvec2& origin_px,
                             std::vector<TagDetection>& found) {
  zarray_t* sightings = apriltag_detector_detect(detector, &image);
  for (int i = 0; i < zarray_size(sightings); ++i) {
    apriltag_detection_t* one = nullptr;
    zarray_get(sightings, i, static_cast<void*>(&one));
    if (!in_use(*one)) continue;  // A tag of others.
    if (static_cast<double>(one->decision_margin) < min_decision_margin) {
      ++dropped.unsure;
    } else {
      found.push_back(to_detection(*one, origin_px));
    }
  }
  apriltag_detections_destroy(sightings);
}

/// Kalibr's boards have black squares that touch the corners of their tags; in a blurred
/// image they merge. Searches again in a sharpened copy, and in one whose white is
/// dilated by a pixel. A second detection at the same place is discarded; the
/// displacement of edges is corrected when the pattern is aligned in the frame itself.
void TagDetector::Impl::find_on_kalibr_board(const image_u8_t& image,
                                             const glm::dvec2& origin_px,
                                             std::vector<TagDetection>& found) {
  const cv::Mat original(image.height, image.width, CV_8UC1, image.buf, image.stride);
  constexpr float kSharpen = -1.5F;
  const int typical_diff = detector->qtp.min_white_black_diff;
  // Also low-contrast boards; this search is rare.
  detector->qtp.min_white_black_diff = 5;
  for (const bool grown : {false, true}) {
    copy.resize(original.total());
    cv::Mat changed(original.size(), CV_8UC1, copy.data());
    if (grown) {
      cv::dilate(original, changed, cv::Mat());  // 3 x 3.
    } else {
      original.copyTo(changed);
    }
    image_u8_t view{changed.cols, changed.rows, changed.cols, changed.data};
    detector->quad_sigma = grown ? 0.0F : kSharpen;
    again.clear();
    find(view, origin_px, again);
    detector->quad_sigma = 0.0F;
    for (const TagDetection& tag : again) {
      const bool known =
          std::any_of(found.begin(), found.end(), [&](const TagDetection& other) {
            return other.id == tag.id &&
                   glm::distance(other.corners_px[0], tag.corners_px[0]) <
                       0.5 * mean_side_px(other.corners_px);
          });
      if (!known) found.push_back(tag);
    }
  }
  detector->qtp.min_white_black_diff = typical_diff;
}

TagDetector::TagDetector(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
TagDetector::TagDetector(TagDetector&&) noexcept = default;
TagDetector& TagDetector::operator=(TagDetector&&) noexcept = default;
TagDetector::~TagDetector() = default;

Result<TagDetector> TagDetector::create(const TagDetectorOptions& options) {
  if (auto error = refusal(options)) return *error;
  return TagDetector(std::make_unique<Impl>(options));
}

std::vector<TagDetection> TagDetector::detect(const GrayFrame& frame) {
  std::vector<TagDetection> tags;
  search(frame, {0, 0, frame.width_px, frame.height_px}, tags);
  finish(frame, tags);
  return tags;
}

void TagDetector::search(const GrayFrame& frame,
                         const PixelBox& box,
                         std::vector<TagDetection>& found) {
  MAREY_ASSERT(frame.pixels != nullptr && frame.stride >= frame.width_px);
  MAREY_ASSERT(box.left >= 0 && box.top >= 0 && box.right <= frame.width_px &&
               box.bottom <= frame.height_px);
  // The library divides the image into tiles and requires at least one.
  constexpr int kMinSide = 16;
  const int width_px = box.right - box.left;
  const int height_px = box.bottom - box.top;
  const double decimate = static_cast<double>(impl_->detector->quad_decimate);
  if (std::min(width_px, height_px) < kMinSide * decimate) return;

  // The library's image is not const, but with quad_sigma 0 it only reads.
  auto* first = const_cast<std::uint8_t*>(
      frame.pixels + static_cast<std::ptrdiff_t>(box.top) * frame.stride + box.left);
  image_u8_t image{width_px, height_px, frame.stride, first};
  impl_->find(image, {box.left, box.top}, found);
  if (impl_->on_kalibr_board) {
    impl_->find_on_kalibr_board(image, {box.left, box.top}, found);
  }
}

void TagDetector::finish(const GrayFrame& frame, std::vector<TagDetection>& found) {
  impl_->dropped.duplicated += keep_unique_ids(found);
  for (TagDetection& tag : found) {
    if (impl_->align_patterns) impl_->align(frame, tag);
    if (tag.hamming > 0) tag.sigma_px *= kCorrectedSigmaFactor;
  }
}

const DroppedSightings& TagDetector::dropped() const {
  return impl_->dropped;
}

}  // namespace marey::capture
