// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/check/assess_floor_height.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "calib/model/board_views.h"
#include "core/base/format_text.h"
#include "core/base/quantile.h"
#include "core/human/average_proportions.h"
#include "core/humanoid.h"
#include "core/pose.h"
#include "core/skeleton.h"

namespace marey::app {
namespace {

using recordings::Session;
using recordings::TrialKind;

// Soles of shoes are about 30 mm thick, and ankles are up to 20 mm higher than average.
constexpr double kFairAbove_m = 0.05;
constexpr double kPoorAbove_m = 0.065;
// No shoe is below the floor.
constexpr double kFairBelow_m = 0.025;
constexpr double kPoorBelow_m = 0.04;
// Ankles with a larger sigma are not used.
constexpr double kMaxAnkleSigma_m = 0.03;
// Largest difference between soles of two trials on one floor.
constexpr double kAlike_m = 0.03;

std::string floor_trial(const Session& session) {
  const recordings::Trial* floor = session.find(TrialKind::kFloor);
  return floor ? "trial " + floor->name : std::string();
}

/// Returns true if the soles have the same height in the motions as in the static trial;
/// nullopt without motions.
std::optional<bool> are_alike(const SoleHeight& standing,
                              std::span<const SoleHeight> motions) {
  if (motions.empty()) return std::nullopt;
  return std::all_of(motions.begin(), motions.end(), [&](const SoleHeight& motion) {
    return std::abs(motion.height_m - standing.height_m) < kAlike_m;
  });
}

std::string next_step(const Session& session,
                      const SoleHeight& standing,
                      std::optional<bool> alike) {
  if (!session.find(TrialKind::kFloor)) {
    return format_text(
        "set lowest_corner_m under [calibration] to %.3f, or record a floor "
        "trial",
        session.calibration.lowest_corner_m - standing.height_m);
  }
  const std::string floor = floor_trial(session);
  const double thickness_m = calib::thickness_m(session.target);
  if (standing.height_m < 0.0) {
    return "check that the board lay on the floor itself in " + floor +
           ", with nothing under it" +
           format_text(", and measure its thickness_m (%.3f in session.toml)",
                       thickness_m);
  }
  if (alike && !*alike) {
    return "record trial " + standing.trial +
           " again with the subject standing on the floor itself";
  }
  if (thickness_m > 0.5 * standing.height_m) {
    return format_text(
        "measure the thickness of the board and correct thickness_m under "
        "[board] (%.3f now, about %.0f mm too much)",
        thickness_m,
        1e3 * standing.height_m);
  }
  return "check that the subject stood on the floor itself in trial " + standing.trial +
         ", and that the board lay on it in " + floor;
}

}  // namespace

std::optional<double> sole_height_m(const EstimatedMotion& estimate, double stature_m) {
  const Proportions average = average_proportions(stature_m);
  double ankle_m = 0.0;  // Above the sole.
  for (const HumanBone bone : {HumanBone::kHips,
                               HumanBone::kLeftUpperLeg,
                               HumanBone::kLeftLowerLeg,
                               HumanBone::kLeftFoot}) {
    ankle_m += average[bone].y;
  }
  const Motion& motion = estimate.motion;
  std::vector<double> lowest_m;
  for (std::size_t f = 0; f < motion.poses.size(); ++f) {
    const auto world = world_from_joints(motion.skeleton, motion.poses[f]);
    std::optional<double> here_m;
    for (const HumanBone foot : {HumanBone::kLeftFoot, HumanBone::kRightFoot}) {
      const JointUncertainty& uncertainty = estimate.uncertainty[f][index(foot)];
      if (uncertainty.source == Source::kInferred &&
          uncertainty.sigma_m > kMaxAnkleSigma_m) {
        continue;
      }
      const double sole_m = world[index(foot)].translation.y - ankle_m;
      here_m = std::min(here_m.value_or(sole_m), sole_m);
    }
    if (here_m) lowest_m.push_back(*here_m);
  }
  if (2 * lowest_m.size() < motion.poses.size() || lowest_m.empty()) return std::nullopt;
  return quantile(std::move(lowest_m), 0.05);
}

std::optional<Finding> assess_floor_height(const Session& session,
                                           const SoleHeight& standing,
                                           std::span<const SoleHeight> motions) {
  const bool is_below = standing.height_m < 0.0;
  const double off_m = std::abs(standing.height_m);
  if (off_m < (is_below ? kFairBelow_m : kFairAbove_m)) return std::nullopt;
  const auto alike = are_alike(standing, motions);
  std::string cause =
      format_text("the soles of the standing subject are %.0f mm %s the floor",
                  1e3 * off_m,
                  is_below ? "below" : "above");
  if (alike) {
    cause += *alike ? ", and equally high in the motions" : ", but not in the motions (";
    for (std::size_t i = 0; i < motions.size() && !*alike; ++i) {
      cause += (i == 0 ? "" : ", ") + motions[i].trial +
               format_text(" %.0f mm", 1e3 * motions[i].height_m);
    }
    cause += *alike ? "" : ")";
  }
  const bool has_floor = session.find(TrialKind::kFloor) != nullptr;
  const bool is_poor = has_floor && off_m > (is_below ? kPoorBelow_m : kPoorAbove_m);
  return Finding{is_poor ? Severity::kPoor : Severity::kFair,
                 "floor",
                 "trial " + standing.trial,
                 std::move(cause),
                 next_step(session, standing, alike)};
}

}  // namespace marey::app
