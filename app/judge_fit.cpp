// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/judge_fit.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "core/pose.h"

namespace marey::app {
namespace {

// Skin, and landmarks that are not where they are on others, leave 5 to 20 mm. [m]
constexpr double kFarOff_m = 0.030;
constexpr double kMostFrames = 0.8;
// Of right labels places_off is 0.6 to 1.4 (fit_labels.cpp).
constexpr double kNobodysPlaces = 2.0;
// Somersaults are shorter.
constexpr double kNearlyAlways = 0.9;

std::string with_number(const char* format, double value) {
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

Error far_off(const MarkerTrial& trial, const SubjectFit* subject) {
  Error error{
      Errc::kQuality,
      trial.path.string(),
      with_number("its markers are %.0f mm away from the body (RMS)",
                  1e3 * trial.solved->rms_m),
      "see which in fit.json: labels may be wrong or moved (--markers MAP.toml), or "
      "the unit (--unit)"};
  if (subject == nullptr) {
    error.next =
        "see which in fit.json, and whether this is the subject of --subject with its "
        "markers where they were";
  }
  return error;
}

/// Labels that were moved to a segment that is no neighbour of the one they are named
/// for.
std::vector<std::string> on_far_segments(const reconstruct::MarkersFit& fit) {
  std::vector<std::string> labels;
  for (const reconstruct::LabelVerdict& verdict : fit.labels) {
    if (verdict.use != reconstruct::LabelUse::kMoved || !verdict.named) continue;
    const HumanBone bone = verdict.segment;
    const HumanBone named = *verdict.named;
    const bool near = parent(bone) == named || parent(named) == bone ||
                      (parent(bone) && parent(bone) == parent(named));
    if (!near) labels.push_back(verdict.label);
  }
  return labels;
}

}  // namespace

double share_solved(const MarkerTrial& trial) {
  const std::size_t frames = frames_with_markers(trial);
  if (!trial.solved || frames == 0) return 0.0;
  return std::min(1.0, trial.solved->frames_solved / static_cast<double>(frames));
}

bool is_upside_down(const MarkerTrial& trial) {
  if (!trial.solved) return false;
  const EstimatedMotion& estimate = trial.solved->estimate;
  std::size_t known = 0;
  std::size_t tipped = 0;
  std::vector<RigidTransform> world_from_joint(kHumanBoneCount);
  for (std::size_t f = 0; f < estimate.motion.poses.size(); ++f) {
    const auto source = [&](HumanBone bone) {
      return estimate.doubt[f][index(bone)].source;
    };
    if (source(HumanBone::kHips) == Source::kInferred) continue;
    world_from_joints(
        estimate.motion.skeleton, estimate.motion.poses[f], world_from_joint);
    const auto height = [&](HumanBone bone) {
      return world_from_joint[index(bone)].translation.y;
    };
    ++known;
    const double head = height(HumanBone::kHead);
    tipped += head < height(HumanBone::kLeftFoot) && head < height(HumanBone::kRightFoot);
  }
  return known > 0 &&
         static_cast<double>(tipped) > kNearlyAlways * static_cast<double>(known);
}

std::vector<Error> judge_fit(std::span<const MarkerTrial> trials,
                             const SubjectFit* subject) {
  std::vector<Error> poor;
  if (subject != nullptr && subject->mirrored_places_off) {
    poor.push_back(
        {Errc::kQuality,
         trials.size() == 1 ? trials[0].path.string() : "",
         "left and right seem exchanged: as they are called, markers sit" +
             with_number(" %.1f times as far from their landmarks as on others,",
                         subject->places_off) +
             with_number(" and %.1f times in the mirror", *subject->mirrored_places_off),
         "call left what is left, in the recording or with --markers MAP.toml, or see "
         "whether the file's axes are left-handed"});
  }
  if (subject != nullptr && poor.empty()) {
    const std::vector<std::string> strayed = on_far_segments(subject->fit);
    if (strayed.size() > 1) {
      poor.push_back({Errc::kQuality,
                      trials.size() == 1 ? trials[0].path.string() : "",
                      "markers move with segments far from those they are named for: \"" +
                          strayed[0] + "\", \"" + strayed[1] + "\"" +
                          (strayed.size() > 2 ? " and more" : ""),
                      "see whether labels, or left and right, are exchanged "
                      "(--markers MAP.toml)"});
    } else if (subject->places_off > kNobodysPlaces) {
      poor.push_back(
          {Errc::kQuality,
           trials.size() == 1 ? trials[0].path.string() : "",
           with_number("markers sit %.1f times as far from their landmarks as "
                       "on others",
                       subject->places_off),
           "see whether labels mean what their names say (--markers MAP.toml), "
           "and the unit (--unit)"});
    }
  }
  for (const MarkerTrial& trial : trials) {
    if (!trial.solved) {
      poor.push_back(
          bad_input(trial.path.string(),
                    "no frame shows six of the subject's markers: the trial is "
                    "not solved",
                    "leave it out, or see its labels in `marey inspect FILE`"));
      continue;
    }
    if (trial.solved->rms_m > kFarOff_m) poor.push_back(far_off(trial, subject));
    if (share_solved(trial) < kMostFrames) {
      poor.push_back({Errc::kQuality,
                      trial.path.string(),
                      with_number("only %.0f %% of its frames are solved",
                                  100.0 * share_solved(trial)),
                      "see in fit.json which markers of hips and chest are missing"});
    }
  }
  return poor;
}

}  // namespace marey::app
