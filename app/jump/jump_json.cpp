// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/jump/jump_json.h"

#include <nlohmann/json.hpp>

#include "app/edit/edit_json.h"
#include "app/shell/findings.h"
#include "core/motion.h"

namespace marey::app {

nlohmann::ordered_json jump_json(const JumpArguments& args, const JumpRun& run) {
  nlohmann::ordered_json figures = nlohmann::ordered_json::object();
  for (const auto& [name, value] : run.report().figures) figures[name] = value;
  const nlohmann::ordered_json of_motion = edit_figures_json(run.figures);
  return {{"out", args.out.string()},
          {"motion", args.motion.string()},
          {"character",
           args.character.empty() ? nlohmann::ordered_json()
                                  : nlohmann::ordered_json(args.character.string())},
          {"jump", args.jump},
          {"law", args.law},
          {"rate_hz", run.state().motion.rate.hz},
          {"frames", run.figures.frames},
          {"figures", figures},
          {"result",
           {{"slide_mm", of_motion.at("slide_mm")},
            {"slide_cm_per_s", of_motion.at("slide_cm_per_s")},
            {"displaced_mm", of_motion.at("displaced_mm")},
            {"acceleration_ratio", of_motion.at("acceleration_ratio")},
            {"inferred_frames", of_motion.at("inferred_frames")}}},
          {"findings", findings_json(run.findings)}};
}

}  // namespace marey::app
