// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/detect_tags.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string_view>
#include <utility>

#include <apriltag/apriltag.h>
#include <apriltag/tag16h5.h>
#include <apriltag/tag25h9.h>
#include <apriltag/tag36h10.h>
#include <apriltag/tag36h11.h>
#include <apriltag/tagCircle21h7.h>
#include <apriltag/tagCircle49h12.h>
#include <apriltag/tagCustom48h12.h>
#include <apriltag/tagStandard41h12.h>
#include <apriltag/tagStandard52h13.h>
#include <glm/geometric.hpp>

#include "capture/align_pattern.h"

namespace marey::capture {
namespace {

struct Family {
  std::string_view name;
  apriltag_family_t* (*create)();
  void (*destroy)(apriltag_family_t*);
};

constexpr std::array<Family, 9> kFamilies{{
    {"tag16h5", tag16h5_create, tag16h5_destroy},
    {"tag25h9", tag25h9_create, tag25h9_destroy},
    {"tag36h10", tag36h10_create, tag36h10_destroy},
    {"tag36h11", tag36h11_create, tag36h11_destroy},
    {"tagCircle21h7", tagCircle21h7_create, tagCircle21h7_destroy},
    {"tagCircle49h12", tagCircle49h12_create, tagCircle49h12_destroy},
    {"tagCustom48h12", tagCustom48h12_create, tagCustom48h12_destroy},
    {"tagStandard41h12", tagStandard41h12_create, tagStandard41h12_destroy},
    {"tagStandard52h13", tagStandard52h13_create, tagStandard52h13_destroy},
}};

const Family* find_family(std::string_view name) {
  const auto found = std::find_if(kFamilies.begin(),
                                  kFamilies.end(),
                                  [&](const Family& f) { return f.name == name; });
  return found == kFamilies.end() ? nullptr : &*found;
}

Error unknown_family(const std::string& name) {
  std::string known;
  for (const Family& family : kFamilies) {
    known += (known.empty() ? "" : ", ") + std::string(family.name);
  }
  return bad_input("tag family",
                   "\"" + name + "\" is not one that marey knows",
                   "use one of " + known);
}

std::optional<Error> refusal(const TagDetectorOptions& options) {
  if (!(options.quad_decimate >= 1.0 && options.quad_decimate <= 16.0)) {
    return bad_input("tag detector",
                     "quad_decimate must be from 1 to 16",
                     "use 1 for the finest corners, 2 for speed");
  }
  if (options.max_hamming < 0 || options.max_hamming > 2) {
    return bad_input("tag detector",
                     "max_hamming must be 0, 1 or 2",
                     "use 1; more takes noise for tags");
  }
  if (options.threads < 1) {
    return bad_input("tag detector", "threads must be at least 1", "use 1");
  }
  return std::nullopt;
}

double mean_side_px(const std::array<glm::dvec2, 4>& corners_px) {
  double sum = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    sum += glm::distance(corners_px[i], corners_px[(i + 1) % 4]);
  }
  return 0.25 * sum;
}

TagDetection to_detection(const apriltag_detection_t& found) {
  TagDetection tag;
  tag.id = TagId{found.id};
  for (std::size_t i = 0; i < 4; ++i) {
    // libapriltag's first pixel has its centre at 0.5, ours at 0.
    tag.corners_px[i] = {found.p[i][0] - 0.5, found.p[i][1] - 0.5};
  }
  tag.sigma_px = edge_corner_sigma_px(mean_side_px(tag.corners_px));
  tag.decision_margin = static_cast<double>(found.decision_margin);
  tag.hamming = found.hamming;
  return tag;
}

TagPattern pattern_of(apriltag_family_t* family, TagId id) {
  image_u8_t* image = apriltag_to_image(family, number(id));
  TagPattern pattern;
  pattern.cells = image->width;
  pattern.margin_cells = (family->total_width - family->width_at_border) / 2;
  for (int y = 0; y < image->height; ++y) {
    const std::uint8_t* row = image->buf + static_cast<std::ptrdiff_t>(y) * image->stride;
    for (int x = 0; x < image->width; ++x) pattern.white.push_back(row[x] != 0 ? 1 : 0);
  }
  image_u8_destroy(image);
  return pattern;
}

/// Sorts by id and drops every id that is there more than once. Returns how many
/// sightings went.
int keep_unique_ids(std::vector<TagDetection>& tags) {
  std::sort(tags.begin(), tags.end(), [](const auto& a, const auto& b) {
    return number(a.id) < number(b.id);
  });
  std::vector<TagDetection> kept;
  kept.reserve(tags.size());
  for (std::size_t first = 0; first < tags.size();) {
    std::size_t last = first + 1;
    while (last < tags.size() && tags[last].id == tags[first].id) ++last;
    if (last == first + 1) kept.push_back(tags[first]);
    first = last;
  }
  const auto dropped = static_cast<int>(tags.size() - kept.size());
  tags = std::move(kept);
  return dropped;
}

}  // namespace

struct TagDetector::Impl {
  Impl(const TagDetectorOptions& options, const Family& its_family)
      : family(its_family),
        codes(its_family.create()),
        detector(apriltag_detector_create()),
        min_decision_margin(options.min_decision_margin),
        align_patterns(options.align_patterns) {
    apriltag_detector_add_family_bits(detector, codes, options.max_hamming);
    detector->nthreads = options.threads;
    detector->quad_decimate = static_cast<float>(options.quad_decimate);
    detector->quad_sigma = 0.0F;  // Anything else would write into the caller's image.
    detector->refine_edges = options.refine_edges;
    detector->debug = false;
    // The margin is about half the difference between a tag's white and black, so that a
    // sure tag has twice this contrast. Duller edges are mostly sensor noise: on noisy
    // 720p video leaving them out took 24 ms a frame in place of 69, and lost no tag.
    detector->qtp.min_white_black_diff =
        std::clamp(static_cast<int>(options.min_decision_margin), 5, 20);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    apriltag_detector_destroy(detector);
    family.destroy(codes);
  }

  void align(const GrayFrame& frame, TagDetection& tag);

  const Family& family;
  apriltag_family_t* codes;
  apriltag_detector_t* detector;
  double min_decision_margin;
  bool align_patterns;
  std::map<TagId, TagPattern> patterns;  ///< Of the tags seen so far.
  DroppedSightings dropped;
};

void TagDetector::Impl::align(const GrayFrame& frame, TagDetection& tag) {
  auto known = patterns.find(tag.id);
  if (known == patterns.end()) {
    known = patterns.emplace(tag.id, pattern_of(codes, tag.id)).first;
  }
  const auto aligned = align_pattern(frame, known->second, tag.corners_px);
  if (!aligned) return;
  tag.corners_px = aligned->corners_px;
  tag.sigma_px = aligned_corner_sigma_px(mean_side_px(tag.corners_px), aligned->blur_px);
}

TagDetector::TagDetector(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
TagDetector::TagDetector(TagDetector&&) noexcept = default;
TagDetector& TagDetector::operator=(TagDetector&&) noexcept = default;
TagDetector::~TagDetector() = default;

Result<TagDetector> TagDetector::create(const TagDetectorOptions& options) {
  const Family* family = find_family(options.family);
  if (family == nullptr) return unknown_family(options.family);
  if (auto error = refusal(options)) return *error;
  return TagDetector(std::make_unique<Impl>(options, *family));
}

std::vector<TagDetection> TagDetector::detect(const GrayFrame& frame) {
  MAREY_ASSERT(frame.pixels != nullptr && frame.stride >= frame.width_px);
  // The library divides the image into tiles and assumes that there are some.
  constexpr int kLeastSide = 16;
  const double decimate = static_cast<double>(impl_->detector->quad_decimate);
  if (std::min(frame.width_px, frame.height_px) < kLeastSide * decimate) return {};

  // The library's image is not const, but with quad_sigma 0 it only reads.
  image_u8_t image{frame.width_px,
                   frame.height_px,
                   frame.stride,
                   const_cast<std::uint8_t*>(frame.pixels)};
  zarray_t* found = apriltag_detector_detect(impl_->detector, &image);
  std::vector<TagDetection> tags;
  for (int i = 0; i < zarray_size(found); ++i) {
    apriltag_detection_t* one = nullptr;
    zarray_get(found, i, static_cast<void*>(&one));
    if (static_cast<double>(one->decision_margin) < impl_->min_decision_margin) {
      ++impl_->dropped.unsure;
    } else {
      tags.push_back(to_detection(*one));
    }
  }
  apriltag_detections_destroy(found);
  impl_->dropped.duplicated += keep_unique_ids(tags);
  if (impl_->align_patterns) {
    for (TagDetection& tag : tags) impl_->align(frame, tag);
  }
  return tags;
}

const DroppedSightings& TagDetector::dropped() const {
  return impl_->dropped;
}

}  // namespace marey::capture
