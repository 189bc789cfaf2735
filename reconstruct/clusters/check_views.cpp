// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/clusters/check_views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>

#include <glm/geometric.hpp>

#include "core/base/quantile.h"
#include "reconstruct/clusters/sightings.h"
#include "reconstruct/clusters/triangulate.h"

namespace marey::reconstruct {
namespace {

constexpr std::size_t kFrames = 200;
constexpr std::size_t kEnough = 6;
// Quick movement seen by cameras a few milliseconds apart is off by some pixels; another
// camera's picture by a hundred.
constexpr double kDisagreePx = 12.0;
// Sides measured by several cameras are accurate to half a percent. A ruler is wrong by
// one percent at most, unless it was misread.
constexpr double kSizeTolerance = 0.025;
constexpr double kCommonTolerance = 0.02;
// A size whose difference varies more between cameras is not a fault of the print.
constexpr double kSizeSpread = 0.06;

struct Agreement {
  /// Per tag sighted twice, by participating camera.
  std::map<std::size_t, std::vector<double>> rms_px;
  std::map<std::size_t, std::vector<double>> size;  ///< Measured over declared, by tag.

  /// Returns the error of the camera that disagrees most: half of all pairs are right if
  /// one camera of four is wrong. nullopt if hardly any tag is seen twice.
  [[nodiscard]] std::optional<double> worst_px() const {
    std::optional<double> worst;
    for (const auto& [camera, samples] : rms_px) {
      if (samples.size() < kEnough) continue;
      worst = std::max(worst.value_or(0.0), median(samples));
    }
    return worst;
  }
};

/// Measurements of one tag by the cameras that see it at once.
struct Measured {
  double rms_px = 0.0;  ///< Worst corner: distance between the cameras' rays.
  /// Mean side; nullopt if the rays are too nearly parallel for a depth.
  std::optional<double> side_m;
};

/// Measures one tag. `camera_of[c]` is the camera whose model explains the c-th video.
Measured measure(std::span<const Camera> cameras,
                 std::span<const std::size_t> camera_of,
                 std::span<const TagSighting> of_tag) {
  // Error of rays that meet behind a camera.
  constexpr double kNoAgreementPx = 1e3;
  Measured out;
  std::array<glm::dvec3, 4> corners{};
  bool has_depth = true;
  for (std::size_t c = 0; c < 4; ++c) {
    std::vector<PointView> views;
    for (const TagSighting& s : of_tag) {
      views.push_back({&cameras[camera_of[index(s.camera)]], s.detection->corners_px[c]});
    }
    auto point = triangulate(views);
    if (!point) {
      // Nearby cameras agree on the direction of distant points.
      has_depth = false;
      point = triangulate(views, {.min_ray_angle_rad = 0.0});
    }
    out.rms_px = std::max(out.rms_px, point ? point->rms_px : kNoAgreementPx);
    if (point) corners[c] = point->p_in_world;
  }
  if (!has_depth) return out;
  double side_m = 0.0;
  for (std::size_t c = 0; c < 4; ++c) {
    side_m += 0.25 * glm::distance(corners[c], corners[(c + 1) % 4]);
  }
  out.side_m = side_m;
  return out;
}

/// Measures all tags that two cameras see at once, in evenly chosen frames.
Agreement compare(std::span<const Camera> cameras,
                  std::span<const std::size_t> camera_of,
                  const Sightings& sightings,
                  std::span<const TagOnSegment> tags) {
  Agreement agreement;
  const std::size_t step = std::max<std::size_t>(1, sightings.frames.size() / kFrames);
  for (std::size_t f = 0; f < sightings.frames.size(); f += step) {
    const std::span<const TagSighting> frame = sightings.frames[f];
    std::size_t end = 0;
    for (std::size_t i = 0; i < frame.size(); i = end) {
      end = i + 1;
      while (end < frame.size() && frame[end].tag == frame[i].tag) ++end;
      if (end - i < 2) continue;
      const auto of_tag = frame.subspan(i, end - i);
      const Measured measured = measure(cameras, camera_of, of_tag);
      for (const TagSighting& s : of_tag) {
        agreement.rms_px[index(s.camera)].push_back(measured.rms_px);
      }
      if (measured.side_m) {
        agreement.size[frame[i].tag].push_back(*measured.side_m /
                                               tags[frame[i].tag].size_m);
      }
    }
  }
  return agreement;
}

std::string text(const char* format, double a, double b = 0.0) {
  std::array<char, 240> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, a, b);
  return buffer.data();
}

Error cameras_disagree(std::span<const CameraDetections> detections,
                       const std::string& by_how_much) {
  return bad_input(detections.front().source,
                   "the cameras do not agree on where the tags are: " + by_how_much,
                   "check that no camera was moved or zoomed after the calibration and "
                   "that all videos of the trial start at the same instant");
}

Status check_cameras(std::span<const Camera> cameras,
                     std::span<const CameraDetections> detections,
                     const Sightings& sightings,
                     std::span<const TagOnSegment> tags,
                     double as_given_px) {
  if (as_given_px < kDisagreePx) return Done{};
  std::vector<std::size_t> order(cameras.size());
  for (std::size_t c = 0; c < order.size(); ++c) order[c] = c;
  double best_px = as_given_px;
  std::size_t best_a = 0;
  std::size_t best_b = 0;
  for (std::size_t a = 0; a < cameras.size(); ++a) {
    for (std::size_t b = a + 1; b < cameras.size(); ++b) {
      std::swap(order[a], order[b]);
      const double exchanged_px =
          compare(cameras, order, sightings, tags).worst_px().value_or(as_given_px);
      std::swap(order[a], order[b]);
      if (exchanged_px >= best_px) continue;
      best_px = exchanged_px;
      best_a = a;
      best_b = b;
    }
  }
  if (best_px < 0.3 * as_given_px) {
    return bad_input(
        detections[best_a].source + " and " + detections[best_b].source,
        "the two cameras' files look exchanged: " +
            text("tags disagree by %.0f px as given, and by %.1f px after a swap",
                 as_given_px,
                 best_px),
        "exchange them under this trial's videos in session.toml, or under the "
        "calibration trial's videos if all other trials report the same");
  }
  return cameras_disagree(detections, text("they differ by %.0f px", as_given_px));
}

/// Returns the relative spread of the middle four fifths of the samples.
double spread(std::vector<double> samples) {
  std::sort(samples.begin(), samples.end());
  const std::size_t tenth = samples.size() / 10;
  return (samples[samples.size() - 1 - tenth] - samples[tenth]) / median(samples);
}

Status check_sizes(const Agreement& agreement,
                   std::span<const CameraDetections> detections,
                   std::span<const TagOnSegment> tags) {
  struct Size {
    std::size_t tag;
    double ratio;  ///< Measured over declared.
    double spread;
  };
  std::vector<Size> sizes;
  std::vector<double> ratios;
  for (const auto& [tag, samples] : agreement.size) {
    if (samples.size() < kEnough) continue;
    sizes.push_back({tag, median(samples), spread(samples)});
    ratios.push_back(sizes.back().ratio);
  }
  if (sizes.empty()) return Done{};
  const double common = median(std::move(ratios));
  const bool all_alike = sizes.size() > 2 && std::ranges::all_of(sizes, [&](auto& size) {
                           return std::abs(size.ratio / common - 1.0) < kSizeTolerance;
                         });
  const bool all_wrong = all_alike && std::abs(common - 1.0) >= kCommonTolerance;
  std::string wrong;
  std::vector<double> spreads;
  for (const Size& size : sizes) {
    if (!all_wrong && std::abs(size.ratio - 1.0) < kSizeTolerance) continue;
    const TagOnSegment& tag = tags[size.tag];
    spreads.push_back(size.spread);
    wrong += (wrong.empty() ? "tag " : ", tag ") + std::to_string(number(tag.id)) +
             text(" measures %.3f m, not %.3f m", size.ratio * tag.size_m, tag.size_m);
  }
  if (wrong.empty()) return Done{};
  // A print has one size. A size that varies between cameras is not a fault of the print.
  const double spread = median(std::move(spreads));
  if (spread > kSizeSpread) {
    return cameras_disagree(
        detections,
        text("the size of one tag differs by %.0f %% between them", 100.0 * spread));
  }
  if (all_wrong) {
    return bad_input(
        "[[tags.tag]] and [board]",
        text("every tag on the body measures %.2f times its size_m against the board",
             common),
        "measure both prints (edge of the black square, in metres): either size_m of the "
        "tags or tag_size_m of the board is wrong");
  }
  return bad_input("[[tags.tag]]",
                   wrong,
                   "measure the print (edge of the black square, in metres) and correct "
                   "size_m in session.toml; if it is right, a camera was moved after the "
                   "calibration");
}

}  // namespace

Status check_views(std::span<const Camera> cameras,
                   std::span<const CameraDetections> detections,
                   std::span<const TagOnSegment> tags) {
  const Sightings sightings = group_sightings(detections, tags);
  std::vector<std::size_t> order(cameras.size());
  for (std::size_t c = 0; c < order.size(); ++c) order[c] = c;
  const Agreement as_given = compare(cameras, order, sightings, tags);
  const auto as_given_px = as_given.worst_px();
  if (!as_given_px) return Done{};
  if (Status ok = check_cameras(cameras, detections, sightings, tags, *as_given_px);
      !ok) {
    return ok;
  }
  return check_sizes(as_given, detections, tags);
}

}  // namespace marey::reconstruct
