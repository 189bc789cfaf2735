// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/check/check_trial_kinds.h"

#include <array>
#include <cstdio>
#include <optional>
#include <span>

#include "reconstruct/motion/measure_travel.h"

namespace marey::app {
namespace {

using recordings::Session;
using recordings::Trial;
using recordings::TrialKind;

// A standing body sways by 20 mm; a quarter of the tags of a moving body travel by
// decimetres.
constexpr double kMoves_m = 0.1;
constexpr double kStands_m = 0.05;

// A body that moves every joint in one place sways by 0.2 m; a walking body travels by
// metres.
constexpr double kWalks_m = 0.5;
constexpr double kStays_m = 0.25;

using Found = std::map<std::string, std::vector<CameraDetections>>;

std::optional<double> travel_in(const Trial& trial,
                                std::span<const TagOnSegment> tags,
                                const Found& found) {
  const auto at = found.find(trial.name);
  if (at == found.end()) return std::nullopt;
  return reconstruct::measure_travel(at->second, tags);
}

std::string in_metres(double m, int decimals) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.*f m", decimals, m);
  return text.data();
}

/// Returns the tags on hips and chest: limbs move in one place too.
std::vector<TagOnSegment> trunk_tags(const Session& session) {
  std::vector<TagOnSegment> tags;
  for (const TagOnSegment& tag : session.tags) {
    if (tag.segment == HumanBone::kHips || tag.segment == HumanBone::kUpperChest) {
      tags.push_back(tag);
    }
  }
  return tags;
}

}  // namespace

Status check_standing(const Session& session,
                      const std::map<std::string, std::vector<CameraDetections>>& found) {
  const Trial* standing = session.find(TrialKind::kStatic);
  if (!standing || session.tags.empty()) return Done{};
  const auto travel_m = travel_in(*standing, session.tags, found);
  if (!travel_m || *travel_m < kMoves_m) return Done{};
  std::string cause =
      "the subject of static trial " + standing->name +
      " does not stand still: a quarter of the tags travel by more than " +
      in_metres(*travel_m, 2);
  std::string next =
      "record it again, with the subject standing still for some seconds; or correct "
      "`videos`, if these are another trial's";
  for (const Trial& trial : session.trials) {
    if (&trial == standing || trial.kind == TrialKind::kCalibration ||
        trial.kind == TrialKind::kFloor) {
      continue;
    }
    const auto other_m = travel_in(trial, session.tags, found);
    if (!other_m || *other_m > kStands_m) continue;
    cause += ", but the subject of trial " + trial.name + " does";
    next = "exchange the videos of " + standing->name + " and " + trial.name +
           ", or their `kind`, in session.toml";
    break;
  }
  return bad_input(
      session.file.string() + ":" + std::to_string(standing->line), cause, next);
}

std::optional<Finding> assess_range_of_motion(
    const Session& session,
    const std::map<std::string, std::vector<CameraDetections>>& found) {
  const Trial* exercise = session.find(TrialKind::kRangeOfMotion);
  if (!exercise) return std::nullopt;
  const std::vector<TagOnSegment> tags = trunk_tags(session);
  const auto travel_m = travel_in(*exercise, tags, found);
  if (!travel_m || *travel_m < kWalks_m) return std::nullopt;
  for (const Trial& trial : session.trials) {
    if (trial.kind != TrialKind::kMotion) continue;
    const auto other_m = travel_in(trial, tags, found);
    if (!other_m || *other_m > kStays_m) continue;
    return fair_finding(
        "exercise",
        session.file.string() + ":" + std::to_string(exercise->line),
        "in trial " + exercise->name +
            ", the range of motion, the subject walks through the room (" +
            in_metres(*travel_m, 1) + "), and in trial " + trial.name +
            " it stays in one place",
        "if the videos of " + exercise->name + " and " + trial.name +
            " are exchanged, correct `videos`, or the trials' `kind`");
  }
  return std::nullopt;
}

}  // namespace marey::app
