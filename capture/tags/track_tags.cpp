// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/tags/track_tags.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/assert.h"

namespace marey::capture {
namespace {

// A tag needs its quiet zone and some of its surroundings to be detected; the rest is for
// the error of its prediction. In sides of the tag; then in px per frame of speed.
constexpr double kPadSides = 0.35;
constexpr double kPadPerSpeed = 0.5;
constexpr double kPadPx = 3.0;
// Largest distance in frames of two sightings for a velocity.
constexpr int kMaxVelocityFrames = 3;
// Margin for the other tags of a body beyond those in view, as a share of the box. A head
// or foot without a visible neighbour may need more.
constexpr double kBodyPad = 0.25;
constexpr double kWideBodyPad = 0.8;
constexpr int kWideEvery = 4;
// A call of the detector costs as much as this number of pixels, however small its box.
constexpr int kPixelsPerCall = 1500;
// Above this share of the image, the whole image is searched instead of boxes.
constexpr double kMaxBoxShare = 0.75;
// Overlap of neighbouring strips: half a near, large tag.
constexpr double kStripOverlap = 0.04;
// Below this share of the recent number of tags, the subject has turned or jumped.
constexpr double kFew = 0.6;
constexpr double kForgotten = 0.98;
constexpr int kFastFullFrames = 6;  // Frames per search of the whole image in that case.
// Corners of threshold tiles: a box that begins there has the same tiles.
constexpr int kTile = 4;

std::int64_t area(const PixelBox& box) {
  return static_cast<std::int64_t>(box.right - box.left) * (box.bottom - box.top);
}

PixelBox hull(const PixelBox& a, const PixelBox& b) {
  return {std::min(a.left, b.left),
          std::min(a.top, b.top),
          std::max(a.right, b.right),
          std::max(a.bottom, b.bottom)};
}

/// Extends to tile borders within the image; empty if outside of it.
PixelBox tiled(const GrayFrame& frame,
               const glm::dvec2& low_px,
               const glm::dvec2& high_px) {
  const auto down = [](double x) {
    return static_cast<int>(std::floor(x / kTile)) * kTile;
  };
  const auto up = [](double x) { return static_cast<int>(std::ceil(x / kTile)) * kTile; };
  const glm::dvec2 size_px(frame.width_px, frame.height_px);
  const glm::dvec2 low = glm::clamp(low_px, glm::dvec2(0.0), size_px);
  const glm::dvec2 high = glm::clamp(high_px, glm::dvec2(0.0), size_px);
  return {down(low.x),
          down(low.y),
          std::min(up(high.x), frame.width_px),
          std::min(up(high.y), frame.height_px)};
}

glm::dvec2 middle_of(const std::array<glm::dvec2, 4>& corners_px) {
  return 0.25 * (corners_px[0] + corners_px[1] + corners_px[2] + corners_px[3]);
}

}  // namespace

TrackTagsOptions live_tracking() {
  TrackTagsOptions options;
  options.full_every_frames = 32;
  options.strips = 16;
  options.body_every_frames = 2;
  return options;
}

Result<TagTracker> TagTracker::create(const TrackTagsOptions& options) {
  MAREY_ASSERT(options.full_every_frames > 0 && options.body_every_frames > 0 &&
               options.remember_frames >= 0 && options.strips > 0);
  // Boxes on a coarser grid would not give the corners of the whole image.
  MAREY_ASSERT(options.detector.quad_decimate == 1.0F);
  auto detector = TagDetector::create(options.detector);
  if (!detector) return detector.error();
  return TagTracker(std::move(*detector), options);
}

TagTracker::TagTracker(TagDetector detector, const TrackTagsOptions& options)
    : options_(options), detector_(std::move(detector)) {}

const std::vector<TagDetection>& TagTracker::track(const GrayFrame& frame) {
  last_search_ = choose_search(frame);
  found_.clear();
  for (const PixelBox& box : boxes_) detector_.search(frame, box, found_);
  if (last_search_ == SearchKind::kStrip) search_strip(frame);
  detector_.finish(frame, found_);
  remember(frame);
  return found_;
}

/// Searches the part of the strip outside the boxes. If it were joined to the boxes, the
/// whole height of the image between them would be searched.
void TagTracker::search_strip(const GrayFrame& frame) {
  const auto known = static_cast<std::ptrdiff_t>(found_.size());
  detector_.search(frame, strip_box_, found_);
  const auto is_known = [&](const TagDetection& tag) {
    const glm::dvec2 middle_px = middle_of(tag.corners_px);
    const double near_px = 0.5 * glm::distance(tag.corners_px[0], tag.corners_px[1]);
    return std::any_of(
        found_.begin(), found_.begin() + known, [&](const TagDetection& other) {
          return other.id == tag.id &&
                 glm::distance(middle_of(other.corners_px), middle_px) < near_px;
        });
  };
  found_.erase(std::remove_if(found_.begin() + known, found_.end(), is_known),
               found_.end());
}

/// Fills boxes_ with the areas to search, and strip_box_ if a strip is due.
SearchKind TagTracker::choose_search(const GrayFrame& frame) {
  const PixelBox whole{0, 0, frame.width_px, frame.height_px};
  const bool is_spread = options_.strips > 1 && next_full_ > 0;
  boxes_.clear();
  SearchKind kind = SearchKind::kFull;
  if (is_spread || (frame.index < next_full_ && !tracks_.empty())) {
    kind = choose_parts(frame, is_spread);
    merge_boxes();
    std::int64_t cost = 0;
    for (const PixelBox& box : boxes_) cost += area(box) + kPixelsPerCall;
    if (static_cast<double>(cost) > kMaxBoxShare * static_cast<double>(area(whole))) {
      kind = SearchKind::kFull;
    }
  }
  if (kind == SearchKind::kFull) {
    boxes_.assign(1, whole);
    next_full_ = frame.index + options_.full_every_frames;
    next_body_ = frame.index + options_.body_every_frames;
  }
  return kind;
}

/// Selects the predicted tags and, at intervals, their surroundings and a strip.
SearchKind TagTracker::choose_parts(const GrayFrame& frame, bool is_spread) {
  predict_boxes(frame);
  // All tracked tags have left the image: another subject may have entered.
  if (boxes_.empty() && !is_spread) return SearchKind::kFull;
  if (is_spread) return choose_spread(frame);
  if (frame.index < next_body_) return SearchKind::kRegions;
  next_body_ = frame.index + options_.body_every_frames;
  choose_body(frame);
  return SearchKind::kBody;
}

/// Selects a strip or a band: both in one frame would take the longest.
SearchKind TagTracker::choose_spread(const GrayFrame& frame) {
  const bool few = static_cast<double>(found_.size()) < kFew * typical_tag_count_;
  if (!boxes_.empty() && !few && frame.index < next_strip_) {
    choose_band(frame);
    return SearchKind::kBody;
  }
  next_strip_ = frame.index + std::max(1, options_.full_every_frames / options_.strips);
  const bool is_fast = boxes_.empty() || few;
  choose_strip(frame, is_fast ? std::max(1, options_.strips / kFastFullFrames) : 1);
  return SearchKind::kStrip;
}

/// Selects the surroundings of all predicted tags, including these.
void TagTracker::choose_body(const GrayFrame& frame) {
  PixelBox body = boxes_.front();
  for (const PixelBox& box : boxes_) body = hull(body, box);
  const glm::dvec2 low(body.left, body.top);
  const glm::dvec2 high(body.right, body.bottom);
  const bool wide = ++body_searches_ % kWideEvery == 0;
  const glm::dvec2 pad = (wide ? kWideBodyPad : kBodyPad) * (high - low);
  boxes_.assign(1, tiled(frame, low - pad, high + pad));
}

/// Selects one band of that area, in addition to the predicted tags: every frame has the
/// same cost. Bands overlap by the largest tracked tag, so that another of its size is
/// completely in one of them.
void TagTracker::choose_band(const GrayFrame& frame) {
  PixelBox body = boxes_.front();
  int tallest_px = 0;
  for (const PixelBox& box : boxes_) {
    body = hull(body, box);
    tallest_px = std::max(tallest_px, box.bottom - box.top);
  }
  const glm::dvec2 pad =
      kBodyPad * glm::dvec2(body.right - body.left, body.bottom - body.top);
  const double top = body.top - pad.y;
  const double height = body.bottom + pad.y - top;
  const int bands = options_.body_every_frames;
  const double overlap = 0.5 * tallest_px;
  const double from = top + height * band_ / bands - overlap;
  const double to = top + height * (band_ + 1) / bands + overlap;
  boxes_.push_back(tiled(frame, {body.left - pad.x, from}, {body.right + pad.x, to}));
  band_ = (band_ + 1) % bands;
}

/// Selects `strips` strips, from the next one on. Neighbours overlap, so that a tag is
/// completely in one of them.
void TagTracker::choose_strip(const GrayFrame& frame, int strips) {
  const double width_px = static_cast<double>(frame.width_px) / options_.strips;
  const double overlap_px = kStripOverlap * frame.width_px;
  const glm::dvec2 low(strip_ * width_px - overlap_px, 0.0);
  const glm::dvec2 high((strip_ + strips) * width_px + overlap_px, frame.height_px);
  strip_box_ = tiled(frame, low, high);
  strip_ += strips;
  if (strip_ >= options_.strips) strip_ = 0;
}

void TagTracker::predict_boxes(const GrayFrame& frame) {
  for (const Track& track : tracks_) {
    const int ahead = frame.index - track.last_frame;
    const glm::dvec2 travel = track.velocity_px * static_cast<double>(ahead);
    glm::dvec2 low = track.corners_px[0];
    glm::dvec2 high = track.corners_px[0];
    for (const glm::dvec2& corner : track.corners_px) {
      low = glm::min(low, corner);
      high = glm::max(high, corner);
    }
    const glm::dvec2 size = high - low;
    // The velocity of a tag with one sighting is unknown.
    const double speed = track.sightings > 1 ? glm::length(track.velocity_px)
                                             : 0.5 * std::max(size.x, size.y);
    const double pad = kPadPx + kPadSides * std::max(size.x, size.y) +
                       kPadPerSpeed * speed * static_cast<double>(ahead);
    const PixelBox box = tiled(frame, low + travel - pad, high + travel + pad);
    if (box.right > box.left && box.bottom > box.top) boxes_.push_back(box);
  }
}

/// Joins boxes that overlap, or that are cheaper in one call than in two.
void TagTracker::merge_boxes() {
  for (std::size_t i = 0; i < boxes_.size();) {
    bool joined = false;
    for (std::size_t j = i + 1; j < boxes_.size(); ++j) {
      const PixelBox both = hull(boxes_[i], boxes_[j]);
      const PixelBox& a = boxes_[i];
      const PixelBox& b = boxes_[j];
      const bool overlap =
          a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
      if (!overlap && area(both) > area(a) + area(b) + kPixelsPerCall) continue;
      boxes_[i] = both;
      boxes_.erase(boxes_.begin() + static_cast<std::ptrdiff_t>(j));
      joined = true;
      break;
    }
    // The enlarged box may overlap earlier ones.
    i = joined ? 0 : i + 1;
  }
}

/// Updates the tracks with the detections, in ascending ids, and removes lost ones.
void TagTracker::remember(const GrayFrame& frame) {
  updated_.clear();
  auto old = tracks_.begin();
  const auto keep_lost_before = [&](auto wanted) {
    for (; old != tracks_.end() && wanted(*old); ++old) {
      if (frame.index - old->last_frame < options_.remember_frames) {
        updated_.push_back(*old);
      }
    }
  };
  for (const TagDetection& tag : found_) {
    keep_lost_before([&](const Track& t) { return number(t.id) < number(tag.id); });
    Track track{tag.id, tag.corners_px, glm::dvec2(0.0), frame.index, 1};
    if (old != tracks_.end() && old->id == tag.id) {
      const int elapsed = frame.index - old->last_frame;
      MAREY_ASSERT(elapsed > 0);
      if (elapsed <= kMaxVelocityFrames) {
        track.velocity_px = (middle_of(tag.corners_px) - middle_of(old->corners_px)) /
                            static_cast<double>(elapsed);
        track.sightings = old->sightings + 1;
      }
      ++old;
    }
    updated_.push_back(track);
  }
  keep_lost_before([](const Track&) { return true; });
  std::swap(tracks_, updated_);
  typical_tag_count_ =
      std::max(static_cast<double>(found_.size()), kForgotten * typical_tag_count_);
}

}  // namespace marey::capture
