// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/markers/assess_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "core/base/format_text.h"
#include "core/pose.h"

namespace marey::app {
namespace {

// Skin motion and individual differences of landmarks cause 5 to 20 mm. [m]
constexpr double kFarOff_m = 0.030;
// Single segments and markers are off by up to 25 and 40 mm in correct recordings: hands
// and shoulders. [m]
constexpr double kSegmentFarOff_m = 0.035;
constexpr double kMarkerFarOff_m = 0.055;
// For a given stature.
constexpr double kOtherStatureSigmas = 4.0;
constexpr double kMinSolvedShare = 0.8;
// Right labels have a places_off of 0.6 to 1.4 (fit_labels.cpp).
constexpr double kMaxPlacesOff = 2.0;

Finding far_off(const MarkerTrial& trial, const LabelledFit* subject) {
  Finding finding{
      Severity::kPoor,
      "fit",
      trial.path.string(),
      format_text("its markers are %.0f mm away from the body (RMS)",
                  1e3 * trial.solved->rms_m),
      "find them in fit.json: labels may be wrong, markers moved (--markers MAP.toml), "
      "or the unit wrong (--unit)"};
  if (subject == nullptr) {
    finding.next =
        "find them in fit.json; check that this is the subject of --subject, with its "
        "markers at the same places";
  }
  return finding;
}

/// Reports the segment or the marker that is farthest off the body.
void assess_worst(const MarkerTrial& trial,
                  const Body& body,
                  std::vector<Finding>& poor) {
  struct Sum {
    double squares = 0.0;
    double frames = 0.0;
  };
  std::array<Sum, kHumanBoneCount> segments{};
  double worst_m = 0.0;
  std::string worst;
  for (std::size_t m = 0; m < body.markers.size(); ++m) {
    const reconstruct::MarkerFit& fit = trial.solved->markers[m];
    Sum& segment = segments[index(body.markers[m].segment)];
    segment.squares += fit.rms_m * fit.rms_m * fit.frames;
    segment.frames += fit.frames;
    if (fit.rms_m <= worst_m) continue;
    worst_m = fit.rms_m;
    worst = body.markers[m].label;
  }
  std::string far;
  double far_m = 0.0;
  for (const HumanBone bone : human_bones()) {
    const Sum& segment = segments[index(bone)];
    if (segment.frames <= 0.0) continue;
    const double rms_m = std::sqrt(segment.squares / segment.frames);
    if (rms_m <= far_m) continue;
    far_m = rms_m;
    far = name(bone);
  }
  if (far_m > kSegmentFarOff_m) {
    poor.push_back({Severity::kPoor,
                    "segment",
                    trial.path.string(),
                    "the markers of " + far +
                        format_text(" are %.0f mm away from the body (RMS)", 1e3 * far_m),
                    "find them in fit.json: labels may be wrong or markers moved "
                    "(--markers MAP.toml)"});
  } else if (worst_m > kMarkerFarOff_m) {
    poor.push_back(
        {Severity::kPoor,
         "marker",
         trial.path.string(),
         "the marker \"" + worst +
             format_text("\" is %.0f mm away from its place (RMS)", 1e3 * worst_m),
         "check whether it fell off or has another's label, and leave it out "
         "with --markers MAP.toml"});
  }
}

Finding other_stature(const reconstruct::MeasuredStature& measured,
                      double given_m,
                      std::span<const MarkerTrial> trials) {
  return {Severity::kPoor,
          "stature",
          trials.size() == 1 ? trials[0].path.string() : "",
          format_text("by its markers the subject is %.2f m tall", measured.stature_m) +
              format_text(" (standard deviation %.2f m)", measured.sigma_m) +
              format_text(", not the %.2f m given", given_m),
          "check --stature, the unit (--unit) and the labels (--markers MAP.toml)"};
}

}  // namespace

double share_solved(const MarkerTrial& trial) {
  const std::size_t frames = frames_with_markers(trial);
  if (!trial.solved || frames == 0) return 0.0;
  return std::min(1.0, trial.solved->frames_solved / static_cast<double>(frames));
}

std::vector<Finding> assess_fit(std::span<const MarkerTrial> trials,
                                const LabelledFit* subject,
                                const Body& body,
                                std::optional<double> stature_m) {
  std::vector<Finding> poor;
  if (subject != nullptr && subject->mirrored_places_off) {
    poor.push_back(
        {Severity::kPoor,
         "sides",
         trials.size() == 1 ? trials[0].path.string() : "",
         "left and right seem exchanged: with these labels, markers are" +
             format_text(" %.1f times as far from their landmarks as on others,",
                         subject->places_off) +
             format_text(" and %.1f times with left and right exchanged",
                         *subject->mirrored_places_off),
         "correct left and right, in the recording or with --markers MAP.toml, or check "
         "whether the file's axes are left-handed"});
  }
  if (subject != nullptr && poor.empty()) {
    if (subject->places_off > kMaxPlacesOff) {
      poor.push_back(
          {Severity::kPoor,
           "places",
           trials.size() == 1 ? trials[0].path.string() : "",
           format_text("markers are %.1f times as far from their landmarks as "
                       "on others",
                       subject->places_off),
           "check the meaning of the labels (--markers MAP.toml), and the unit "
           "(--unit)"});
    }
  }
  if (subject != nullptr && stature_m && subject->fit.measured_stature) {
    const reconstruct::MeasuredStature& measured = *subject->fit.measured_stature;
    if (std::abs(measured.stature_m - *stature_m) >
        kOtherStatureSigmas * measured.sigma_m) {
      poor.push_back(other_stature(measured, *stature_m, trials));
    }
  }
  for (const MarkerTrial& trial : trials) {
    if (!trial.solved) {
      poor.push_back(tolerated(
          Severity::kPoor,
          "unsolved",
          bad_input(trial.path.string(),
                    "no frame shows six of the subject's markers: the trial is "
                    "not solved",
                    "leave it out, or see its labels in `marey inspect FILE`")));
      continue;
    }
    if (trial.solved->rms_m > kFarOff_m) {
      poor.push_back(far_off(trial, subject));
    } else {
      assess_worst(trial, body, poor);
    }
    if (share_solved(trial) < kMinSolvedShare) {
      poor.push_back({Severity::kPoor,
                      "unsolved",
                      trial.path.string(),
                      format_text("only %.0f %% of its frames are solved",
                                  100.0 * share_solved(trial)),
                      "see in fit.json which markers of hips and chest are missing"});
    }
  }
  return poor;
}

}  // namespace marey::app
