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
  std::string words;  ///< Description of the body.
};

/// Result of one clip on one body.
struct CampaignResult {
  std::string body, clip;
  /// Error of the program or of the judge; "" if there is none.
  std::string error;
  std::optional<double> reported_depth_mm;     ///< deepest_penetration_mm.
  std::optional<double> reported_foot_deg;     ///< posture.feet.sustained_deg.
  std::vector<std::string> reported_problems;  ///< The report's findings of this body.
  std::optional<BodyFigures> judged;
  int exit_code = -1;  ///< Exit code of the run that made all bodies.
};

/// Returns the gross errors of a result, a few words each; empty if there are none. Gross
/// errors are: skin more than 5 mm below the floor where the source is not, a leg's
/// segment or a trunk whose median direction differs by more than 25 degrees from the
/// source's, an arm's by more than 60 (wide bodies push arms away), left and right
/// exchanged, speeds over twice the source's and 12 heights a second, a foot whose yaw
/// differs by more than 45 degrees from the source's for a quarter of a second, a
/// reported depth that differs from the judge's.
[[nodiscard]] std::vector<std::string> gross_errors(const CampaignResult& result);

/// Runs `marey retarget CLIP BODIES... --formats glb --json` in `folder` once, with
/// `more` arguments, and judges each written file.
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
