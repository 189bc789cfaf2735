// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/quality/assess_target_views.h"

#include <algorithm>
#include <array>

#include "calib/quality/calibration_limits.h"
#include "core/base/degrees.h"

namespace marey::calib {
namespace {

// Zhang (2000, 4): errors decrease with the number of views up to about ten. With fewer
// than four views, the lens and its sigmas depend on the priors.
constexpr int kPoorViews = 4;
constexpr int kFairViews = 10;
constexpr double kPoorCoverage = kCoverageLimits[1];
constexpr double kFairCoverage = kCoverageLimits[0];
// Coverage of a half that was hardly shown while the other was.
constexpr double kEmptyHalf = 0.15;
constexpr double kShownHalf = 0.4;
// In frontal views, focal length and distance of a board are ambiguous; from a tilt of 15
// degrees, perspective separates them (Sturm and Maybank 1999 for the degenerate case).
constexpr double kFairTilt_rad = 15.0 / kDegreesPerRadian;

void assess_coverage(FindingCollector& list, std::size_t c) {
  const CameraMeasures& camera = list.report.cameras[c];
  const CameraQuality& quality = list.report.rig.quality[c];
  const std::string target = list.target();
  if (quality.coverage < kFairCoverage) {
    list.add_mergeable(
            quality.coverage < kPoorCoverage ? Severity::kPoor : Severity::kFair,
            "coverage",
            c,
            format_text("it saw the %s in %.0f %% of its picture (good: above %.0f %%), "
                        "and its lens "
                        "is uncertain in the rest",
                        target.c_str(),
                        100.0 * quality.coverage,
                        100.0 * kFairCoverage),
            "move the " + target + " slowly through the whole picture, up to the edges",
            format_text("%.0f %%", 100.0 * quality.coverage),
            format_text(
                "they saw the %s in this share of their pictures only (good: above "
                "%.0f %%), and their lenses are uncertain in the rest",
                target.c_str(),
                100.0 * kFairCoverage))
        .measured(100.0 * quality.coverage, 100.0 * kFairCoverage, "%");
    return;
  }
  constexpr std::array<const char*, 4> kHalves{"left", "right", "upper", "lower"};
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t other = i ^ 1U;
    if (camera.half_coverage[i] > kEmptyHalf ||
        camera.half_coverage[other] < kShownHalf) {
      continue;
    }
    list.add(
        Severity::kFair,
        "coverage",
        list.camera(c),
        format_text("it saw the %s in %.0f %% of the %s half of its picture, against "
                    "%.0f %% of the other",
                    target.c_str(),
                    100.0 * camera.half_coverage[i],
                    kHalves[i],
                    100.0 * camera.half_coverage[other]),
        format_text("show it the %s in the %s half too", target.c_str(), kHalves[i]));
  }
}

void assess_camera(FindingCollector& list, std::size_t c) {
  const CameraMeasures& camera = list.report.cameras[c];
  const std::string target = list.target();
  if (camera.instants < kFairViews) {
    list.add_mergeable(
            camera.instants < kPoorViews ? Severity::kPoor : Severity::kFair,
            "views",
            c,
            format_text(
                "it saw the moving %s at %d instants (good: %d or more), too few for a "
                "reliable error",
                target.c_str(),
                camera.instants,
                kFairViews),
            "wave the " + target + " longer in its view: half a minute",
            format_text("%d", camera.instants),
            format_text("they saw the moving %s at too few instants for reliable errors "
                        "(good: %d or "
                        "more)",
                        target.c_str(),
                        kFairViews))
        .measured(camera.instants, kFairViews, "instants");
  }
  assess_coverage(list, c);
  if (!camera.tilts.empty() && camera.p90_tilt_rad < kFairTilt_rad) {
    list.add_mergeable(
            Severity::kFair,
            "tilt",
            c,
            format_text("the board was hardly tilted: nine of ten views by less than "
                        "%.0f degrees "
                        "(good: more than %.0f), so its focal length is uncertain",
                        camera.p90_tilt_rad * kDegreesPerRadian,
                        kFairTilt_rad * kDegreesPerRadian),
            "tilt the board to all sides by 30 to 45 degrees in its view",
            format_text("%.0f degrees", camera.p90_tilt_rad * kDegreesPerRadian),
            format_text("nine of ten views of the board were tilted less than that "
                        "(good: more than "
                        "%.0f), so their focal lengths are uncertain",
                        kFairTilt_rad * kDegreesPerRadian))
        .measured(camera.p90_tilt_rad * kDegreesPerRadian,
                  kFairTilt_rad * kDegreesPerRadian,
                  "degrees");
  }
}

/// Computes the spanning tree of the strongest links between cameras (Kruskal 1956) and
/// reports its weak links.
void assess_shared(FindingCollector& list) {
  const std::size_t count = list.report.rig.cameras.size();
  const std::vector<int>& shared = list.report.rig.shared_views;
  if (shared.size() != count * count) return;
  struct Link {
    std::size_t a = 0;
    std::size_t b = 0;
    int instants = 0;
  };
  std::vector<Link> links;
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = a + 1; b < count; ++b) {
      links.push_back({a, b, shared[a * count + b]});
    }
  }
  std::stable_sort(links.begin(), links.end(), [](const Link& x, const Link& y) {
    return x.instants > y.instants;
  });
  std::vector<std::size_t> group(count);
  for (std::size_t c = 0; c < count; ++c) group[c] = c;
  for (const Link& link : links) {
    const std::size_t from = group[link.b];
    const std::size_t to = group[link.a];
    if (from == to) continue;
    std::replace(group.begin(), group.end(), from, to);
    if (link.instants >= kFairShared) continue;
    list.add(Severity::kFair,
             "shared",
             list.both(link.a, link.b),
             format_text(
                 "they saw the %s together at %d instants (good: %d or more), and no "
                 "other cameras connect them better",
                 list.target(),
                 link.instants,
                 kFairShared),
             format_text("hold the %s where both see it, in many places and postures",
                         list.target()))
        .measured(link.instants, kFairShared, "instants");
  }
}

}  // namespace

void assess_target_views(FindingCollector& list) {
  for (std::size_t c = 0; c < list.report.cameras.size(); ++c) assess_camera(list, c);
  assess_shared(list);
}

}  // namespace marey::calib
