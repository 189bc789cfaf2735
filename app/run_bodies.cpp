// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdio>
#include <utility>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/retarget_files.h"
#include "core/extension.h"
#include "recordings/gltf.h"

namespace marey::app {

Exit run_retarget(const BodyFile& motion,
                  const BodyFile& avatar,
                  const std::filesystem::path& out,
                  bool json,
                  Console& console) {
  auto raw = read_raw_body(motion.path);
  if (!raw) return console.fail(raw.error());
  if (!raw->has_motion) {
    return console.fail(bad_input(
        motion.path.string(), "holds no animation", "give a file with a motion"));
  }
  if (const auto note = left_out({{}, raw->ignored_translation_m})) {
    console.warn(motion.path.string() + ": " + *note);
  }
  if (const Status ok = check_avatar(avatar); !ok) return console.fail(ok.error());
  const auto source = identify_body(*std::move(raw), motion);
  if (!source) return console.fail(source.error());
  for (const std::string& remark : source->remarks()) {
    console.warn(motion.path.string() + ": " + remark);
  }
  const auto result = retarget_to_file(source->raw.motion, avatar, out);
  if (!result) return console.fail(result.error());
  for (const std::string& remark : result->remarks) {
    console.warn(avatar.path.string() + ": " + remark);
  }
  const retarget::RetargetReport& report = result->retargeted.report;
  if (json) {
    const nlohmann::ordered_json figures{
        {"out", out.string()},
        {"frames", result->retargeted.motion.poses.size()},
        {"slide_before_cm_per_s", report.before.mean_slide_cm_per_s},
        {"slide_after_cm_per_s", report.after.mean_slide_cm_per_s},
        {"deepest_penetration_mm", report.after.deepest_penetration_mm},
        {"unreachable_frames", report.ground.unreachable_frames}};
    std::printf("%s\n", figures.dump(2).c_str());
  }
  std::array<char, 200> text{};
  std::snprintf(text.data(),
                text.size(),
                "%s: %zu frames, stance feet slide %.2f cm/s (%.2f before the ground), "
                "deepest foot %.1f mm",
                out.string().c_str(),
                result->retargeted.motion.poses.size(),
                report.after.mean_slide_cm_per_s,
                report.before.mean_slide_cm_per_s,
                report.after.deepest_penetration_mm);
  console.say(text.data());
  return Exit::kOk;
}

Exit run_mannequin(const recordings::MannequinOptions& options,
                   const recordings::MannequinStyle& style,
                   const std::filesystem::path& out,
                   Console& console) {
  if (kind_by_extension(out) != ".glb") {
    return console.fail(bad_input(
        out.string(), "a mannequin is written as GLB alone", "name the result .glb"));
  }
  const Proportions proportions = recordings::mannequin_proportions(options);
  const Status ok =
      recordings::write_character(out,
                                  make_humanoid(proportions),
                                  recordings::make_mannequin_mesh(proportions, style));
  if (!ok) return console.fail(ok.error());
  console.say("mannequin: " + out.string());
  return Exit::kOk;
}

}  // namespace marey::app
