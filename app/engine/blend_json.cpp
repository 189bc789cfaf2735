// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/engine/blend_json.h"

#include <nlohmann/json.hpp>

#include "core/base/format_text.h"
#include "core/base/in_quotes.h"

namespace marey::app {

nlohmann::ordered_json blend_json(const BlendArguments& args,
                                  const BlendInputs& inputs,
                                  const PlayedBlend& played,
                                  const BlendFigures& figures) {
  using Json = nlohmann::ordered_json;
  Json slide;
  if (figures.slide) {
    slide = {{"mean", figures.slide->mean_cm_s},
             {"worst", figures.slide->worst_cm_s},
             {"clips_mean", figures.slide->clips_mean_cm_s}};
  }
  const auto& poses = played.motion.poses;
  return {
      {"out", args.out.string()},
      {"from", inputs.from_clip().name},
      {"to", inputs.to_clip().name},
      {"body", inputs.character.name},
      {"kind", args.kind},
      {"fade_s", args.fade_s},
      {"at_s", args.at_s},
      {"switch_frame", played.switch_frame},
      {"rate_hz", played.motion.rate.hz},
      {"frames", poses.size()},
      {"transition", figures.transition},
      {"entry_s", figures.entry_s},
      {"incompatible_s", figures.incompatible_s ? Json(*figures.incompatible_s) : Json()},
      {"slide_cm_s", slide},
      {"acceleration_ratio", figures.acceleration_ratio},
      {"accelerated_bone", name(figures.accelerated_bone)},
      {"accelerated_s", figures.accelerated_s},
      {"hips_departure_cm", figures.hips_departure_cm},
      {"remarks", figures.remarks}};
}

std::vector<std::string> blend_lines(const BlendArguments& args,
                                     const BlendInputs& inputs,
                                     const BlendFigures& figures) {
  std::vector<std::string> out;
  out.push_back(
      format_text("switch: %s, ", figures.transition.c_str()) +
      in_quotes(inputs.from_clip().name) + format_text(" at %.2f s, ", args.at_s) +
      in_quotes(inputs.to_clip().name) + format_text(" from %.2f s", figures.entry_s));
  out.push_back(figures.incompatible_s
                    ? format_text("supports: incompatible for %.2f s of the plan%s",
                                  *figures.incompatible_s,
                                  figures.transition == "inertial" ? ", not used" : "")
                    : std::string("supports: not matched"));
  out.push_back(
      figures.slide
          ? format_text("feet: bearing feet slide %.1f cm/s on average (clips %.1f), at "
                        "most %.1f",
                        figures.slide->mean_cm_s,
                        figures.slide->clips_mean_cm_s,
                        figures.slide->worst_cm_s)
          : std::string("feet: none bears after the switch"));
  out.push_back(
      format_text("acceleration: largest %.2f times that of the clips, %s at "
                  "%.2f s",
                  figures.acceleration_ratio,
                  std::string(name(figures.accelerated_bone)).c_str(),
                  figures.accelerated_s));
  out.push_back(
      format_text("hips: at most %.1f cm from the blend", figures.hips_departure_cm));
  return out;
}

}  // namespace marey::app
