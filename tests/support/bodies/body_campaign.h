// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/humanoid.h"
#include "tests/support/truth/body_judge.h"

namespace marey::testing {

/// A body of a campaign.
struct CampaignBody {
  std::filesystem::path path;
  std::map<HumanBone, std::string> nodes;
  std::string words;  ///< What it is like.
};

/// What became of one clip on one body.
struct CampaignResult {
  std::string body, clip;
  /// What the program says of it: an error, or "" with its figures.
  std::string error;
  std::optional<double> told_depth_mm;     ///< deepest_penetration_mm.
  std::optional<double> told_foot_deg;     ///< posture.feet.sustained_deg.
  std::vector<std::string> told_problems;  ///< The report's findings of this body.
  std::optional<BodyFigures> judged;
  int exit_code = -1;  ///< Of the run that made all bodies.
};

/// How a result is wrong beyond doubt, in a word or two; empty: it is not. Skin more than
/// 5 mm below the floor where the source is not, a leg's segment or a trunk whose median
/// is more than 25 degrees away from the source's, an arm's 60 (arms give way to wide
/// bodies), left and right exchanged, speeds over twice the
/// source's and 12 heights a second, a foot whose yaw is over 45 degrees off the source's
/// for a quarter of a second, a figure that is not the judge's.
[[nodiscard]] std::vector<std::string> gross_errors(const CampaignResult& result);

/// Runs `marey retarget CLIP BODIES... --formats glb --json` in `folder` once, with
/// `more` arguments, and judges each file that leaves.
[[nodiscard]] std::vector<CampaignResult> run_campaign(
    const std::filesystem::path& program,
    const std::filesystem::path& folder,
    const std::filesystem::path& clip,
    const std::vector<CampaignBody>& bodies,
    const std::vector<std::string>& more = {});

/// Generated bodies of these seeds, written into `folder`.
[[nodiscard]] std::vector<CampaignBody> made_bodies(const std::filesystem::path& folder,
                                                    std::uint64_t first_seed,
                                                    int count);

}  // namespace marey::testing
