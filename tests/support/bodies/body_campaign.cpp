// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/bodies/body_campaign.h"

#include <cmath>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "tests/support/bodies/made_body.h"
#include "tests/support/program/run_program.h"

namespace marey::testing {

std::vector<std::string> gross_errors(const CampaignResult& result) {
  std::vector<std::string> out;
  if (!result.judged) return out;
  const BodyFigures& judged = *result.judged;
  constexpr double kSkin_mm = 5.0;
  // The source's joints below its own floor leave as much to the body, twice at most.
  if (judged.skin_depth_mm > kSkin_mm + 2.0 * judged.source_depth_mm) {
    out.emplace_back("skin in the floor");
  }
  if (judged.worst_median_deg > 25.0) out.emplace_back("leg or trunk direction");
  if (judged.arms_median_deg > 60.0) out.emplace_back("arm direction");
  if (judged.foot_yaw_deg > 45.0) out.emplace_back("foot direction");
  if (judged.exchanged_share > 0.5) out.emplace_back("left and right exchanged");
  if (judged.max_speed > 12.0 && judged.max_speed > 2.0 * judged.source_max_speed) {
    out.emplace_back("speed");
  }
  if (result.reported_depth_mm) {
    const double off_mm = std::abs(*result.reported_depth_mm - judged.skin_depth_mm);
    if (off_mm > 0.1 * judged.skin_depth_mm + 0.5)
      out.emplace_back("reported skin depth");
  }
  return out;
}

std::vector<CampaignResult> run_campaign(const std::filesystem::path& program,
                                         const std::filesystem::path& folder,
                                         const std::filesystem::path& clip,
                                         const std::vector<CampaignBody>& bodies,
                                         const std::vector<std::string>& more) {
  const std::vector<Landmarks> source = read_landmarks(clip);
  const std::string out_name = "out-" + clip.stem().string();
  std::vector<std::string> arguments{"retarget", clip.string()};
  for (const CampaignBody& body : bodies) arguments.push_back(body.path.string());
  for (const char* word : {"--formats", "glb", "--json", "--out"}) {
    arguments.emplace_back(word);
  }
  arguments.push_back(out_name);
  arguments.insert(arguments.end(), more.begin(), more.end());
  const ProgramRun run =
      run_program(program, arguments, {.folder = folder, .interrupt_at = {}});
  const auto json = nlohmann::json::parse(run.out, nullptr, false);
  std::vector<CampaignResult> results;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    CampaignResult result;
    result.body = bodies[i].path.stem().string();
    result.clip = clip.stem().string();
    result.exit_code = run.exit_code;
    if (json.is_discarded() || !json.contains("avatars") || json["avatars"].size() <= i) {
      result.error = run.err;
      results.push_back(std::move(result));
      continue;
    }
    const auto& figures = json["avatars"][i];
    result.error = figures.value("error", "");
    if (figures.contains("deepest_penetration_mm")) {
      result.reported_depth_mm = figures["deepest_penetration_mm"].get<double>();
    }
    if (figures.contains("posture")) {
      result.reported_foot_deg =
          figures["posture"]["feet"]["sustained_deg"].get<double>();
    }
    if (figures.contains("problems")) {
      for (const auto& problem : figures["problems"]) {
        result.reported_problems.push_back(problem.get<std::string>());
      }
    }
    const auto made = folder / out_name / (result.body + ".glb");
    if (result.error.empty() && std::filesystem::exists(made)) {
      try {
        PosedGlb glb(made);
        result.judged = judge_body(glb, bodies[i].nodes, source);
      } catch (const std::exception& problem) {
        result.error = std::string("judge: ") + problem.what();
      }
    }
    results.push_back(std::move(result));
  }
  return results;
}

std::vector<CampaignBody> made_bodies(const std::filesystem::path& folder,
                                      std::uint64_t first_seed,
                                      int count) {
  std::vector<CampaignBody> out;
  for (int i = 0; i < count; ++i) {
    const std::uint64_t seed = first_seed + static_cast<std::uint64_t>(i);
    const MadeBodyRule rule = made_body_rule(seed);
    CampaignBody body{folder / ("made" + std::to_string(seed) + ".glb"), {}, words(rule)};
    body.nodes = write_made_body(rule, body.path);
    out.push_back(std::move(body));
  }
  return out;
}

}  // namespace marey::testing
