// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Measures the cost and the losses of tag tracking against a search of every whole frame.
// Both run on the same decoded frames, in turn, in one process. Times are
// processor time.
//
//   measure_detection ../shared/data/blender/dev walk reach jump rom static calib
//
// Prints per trial: the tags found by both, lost, or found by the tracker alone; the
// ratio of times, over all frames and over frames with a search of regions only; the
// distance between the corners of the two methods; and the distance of the tracker's
// corners from the truth, per size of the tag, in cameras that run with the truth's
// clock.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <time.h>

#include "capture/tags/track_tags.h"
#include "capture/video/frame_source.h"
#include "capture/video/open_frames.h"
#include "tests/support/program/thread_time.h"
#include "tests/support/truth/rendered_truth.h"

namespace marey::capture {
namespace {

/// Processor time of a call.
template <class Call>
double timed(const Call& call) {
  const double start_s = testing::thread_time_s();
  call();
  return testing::thread_time_s() - start_s;
}

struct Tally {
  int both = 0;
  int lost = 0;
  int more = 0;  ///< Found by the tracker alone.
  double squares = 0.0;
  double full_s = 0.0;
  double tracked_s = 0.0;
  double regions_s = 0.0;
  double full_of_regions_s = 0.0;
  int frames = 0;
  int region_frames = 0;
};

void compare(const std::vector<TagDetection>& full,
             const std::vector<TagDetection>& tracked,
             Tally& tally) {
  std::map<TagId, const TagDetection*> by_id;
  for (const TagDetection& tag : full) by_id[tag.id] = &tag;
  for (const TagDetection& tag : tracked) {
    const auto other = by_id.find(tag.id);
    if (other == by_id.end()) {
      ++tally.more;
      continue;
    }
    ++tally.both;
    for (std::size_t c = 0; c < 4; ++c) {
      const glm::dvec2 apart = tag.corners_px[c] - other->second->corners_px[c];
      tally.squares += 0.5 * glm::dot(apart, apart);
    }
    by_id.erase(other);
  }
  tally.lost += static_cast<int>(by_id.size());
}

CameraDetections follow(const std::filesystem::path& video, Tally& tally) {
  CameraDetections out;
  auto source = open_frames(video);
  auto detector = TagDetector::create();
  auto tracker = TagTracker::create();
  if (!source || !detector || !tracker) {
    std::fprintf(stderr, "%s cannot be read\n", video.c_str());
    std::exit(1);
  }
  out.width_px = (*source)->info().width_px;
  out.height_px = (*source)->info().height_px;
  while (true) {
    const auto frame = (*source)->next();
    if (!frame) {
      std::fprintf(stderr, "%s\n", frame.error().message().c_str());
      std::exit(1);
    }
    if (!*frame) break;
    // The second method finds the picture in the cache, so the order alternates.
    std::vector<TagDetection> full;
    const auto search_whole = [&] { full = detector->detect(**frame); };
    const std::vector<TagDetection>* followed = nullptr;
    const auto follow_tags = [&] { followed = &tracker->track(**frame); };
    const bool whole_first = (*frame)->index % 2 == 0;
    const double first_s = whole_first ? timed(search_whole) : timed(follow_tags);
    const double second_s = whole_first ? timed(follow_tags) : timed(search_whole);
    const double full_s = whole_first ? first_s : second_s;
    const double tracked_s = whole_first ? second_s : first_s;
    const std::vector<TagDetection>& tracked = *followed;
    tally.full_s += full_s;
    tally.tracked_s += tracked_s;
    ++tally.frames;
    if (tracker->last_search() == SearchKind::kRegions) {
      tally.full_of_regions_s += full_s;
      tally.regions_s += tracked_s;
      ++tally.region_frames;
    }
    compare(full, tracked, tally);
    out.frames.push_back({(*frame)->index, tracked});
  }
  return out;
}

struct Bucket {
  int corners = 0;
  double squares = 0.0;
  double normalized = 0.0;
  glm::dvec2 sum{0.0};
  double outward = 0.0;
};

void add_residuals(const std::vector<tests::CornerResidual>& residuals,
                   std::map<int, Bucket>& buckets) {
  for (const auto& r : residuals) {
    // A detection at another tag's position is no corner error.
    constexpr double kElsewherePx = 5.0;
    if (glm::length(r.error_px) > kElsewherePx) continue;
    Bucket& bucket = buckets[static_cast<int>(r.side_px / 4.0) * 4];
    ++bucket.corners;
    bucket.squares += 0.5 * glm::dot(r.error_px, r.error_px);
    bucket.normalized +=
        0.5 * glm::dot(r.error_px, r.error_px) / (r.sigma_px * r.sigma_px);
    bucket.sum += r.error_px;
    bucket.outward += glm::dot(r.error_px, r.outward_px);
  }
}

int wrong_ids(const std::vector<tests::CornerResidual>& residuals) {
  constexpr double kElsewherePx = 8.0;
  return static_cast<int>(std::count_if(
      residuals.begin(), residuals.end(), [](const tests::CornerResidual& r) {
        return r.corner == 0 && glm::length(r.error_px) > kElsewherePx;
      }));
}

void print_buckets(const std::map<int, Bucket>& buckets) {
  for (const auto& [side, b] : buckets) {
    const double n = b.corners;
    std::printf(
        "    side %2d to %2d px: %6d corners, RMS %.3f px, bias %+.3f %+.3f px, outward "
        "%+.3f px, error / sigma %.2f\n",
        side,
        side + 4,
        b.corners,
        std::sqrt(b.squares / n),
        b.sum.x / n,
        b.sum.y / n,
        b.outward / n,
        std::sqrt(b.normalized / n));
  }
}

void measure(const std::filesystem::path& session, std::map<int, Bucket>& all) {
  const auto truth = tests::load_rendered_truth(session);
  Tally tally;
  std::map<int, Bucket> buckets;
  int wrong = 0;
  for (std::size_t c = 0; c < truth.cameras.size(); ++c) {
    const CameraDetections found = follow(truth.video(c), tally);
    const auto residuals = tests::residuals(truth, c, found);
    wrong += wrong_ids(residuals);
    // The truth of a late camera lies between frames and is too inaccurate.
    if (truth.late_frames[c] != 0.0) continue;
    add_residuals(residuals, buckets);
    add_residuals(residuals, all);
  }
  const int of_full = tally.both + tally.lost;
  std::printf(
      "%s: %d frames, %d tags; found %.2f %%, %d more, %d elsewhere than in truth; time "
      "%.3f of full frames (%.1f ms to %.1f), %.3f in the %.0f %% that are regions only; "
      "corners %.3f px RMS apart\n",
      session.filename().c_str(),
      tally.frames,
      of_full,
      100.0 * tally.both / std::max(1, of_full),
      tally.more,
      wrong,
      tally.tracked_s / tally.full_s,
      1e3 * tally.tracked_s / tally.frames,
      1e3 * tally.full_s / tally.frames,
      tally.region_frames > 0 ? tally.regions_s / tally.full_of_regions_s : 0.0,
      100.0 * tally.region_frames / tally.frames,
      std::sqrt(tally.squares / (4.0 * std::max(1, tally.both))));
  print_buckets(buckets);
}

}  // namespace
}  // namespace marey::capture

int main(int count, char** arguments) {
  if (count < 3) {
    std::fprintf(stderr, "usage: measure_detection DATA TRIAL...\n");
    return 2;
  }
  std::map<int, marey::capture::Bucket> all;
  for (int i = 2; i < count; ++i) {
    marey::capture::measure(std::filesystem::path(arguments[1]) / arguments[i], all);
  }
  std::printf("all trials:\n");
  marey::capture::print_buckets(all);
  return 0;
}
