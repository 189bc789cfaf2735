// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/engine/base_json.h"

#include <cstddef>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/library/find/clip_table.h"
#include "core/base/format_text.h"
#include "recordings/moves/clip_figures.h"

namespace marey::app {
namespace {

using BaseJson = nlohmann::ordered_json;

std::string joined_tags(const MotionClip& clip) {
  std::string text;
  for (const std::string& tag : clip.tags) text += (text.empty() ? "" : ", ") + tag;
  return text;
}

/// Returns a number of the file as the shortest decimal number of its 32 bits.
double short_number(float value) {
  return std::stod(format_text("%.7g", static_cast<double>(value)));
}

BaseJson base_clip_json(const engine::MotionBase& base, std::size_t i) {
  const MotionClip& clip = base.clip(i);
  BaseJson notes = BaseJson::array();
  for (const Annotation& note : clip.notes) {
    notes.push_back(
        {{"text", note.text}, {"start_s", note.start_s}, {"end_s", note.end_s}});
  }
  return {{"name", clip.name},
          {"seconds", clip.duration_s()},
          {"rate_hz", short_number(clip.rate_hz)},
          {"frames", clip.frames.size()},
          {"phases", base.phases(i).size()},
          {"supports", recordings::supports_of(clip)},
          {"speed_m_s", recordings::mean_speed_m_s(clip)},
          {"loops", clip.loops},
          {"tags", clip.tags},
          {"notes", std::move(notes)},
          {"constraints", clip.constraints.constraints.size()},
          {"body", clip.body},
          {"leg_length_m", short_number(clip.leg_length_m)},
          {"document_sha256", clip.document_sha256},
          {"recipe_sha256", clip.recipe_sha256},
          {"bytes", recordings::clip_bytes(clip)}};
}

}  // namespace

std::string base_table(const engine::MotionBase& base) {
  std::vector<std::vector<std::string>> rows{
      {"name", "seconds", "rate", "phases", "speed", "loops", "tags", "bytes"}};
  for (std::size_t i = 0; i < base.clips().size(); ++i) {
    const MotionClip& clip = base.clip(i);
    rows.push_back({clip.name,
                    format_text("%.2f s", clip.duration_s()),
                    format_text("%.6g Hz", static_cast<double>(clip.rate_hz)),
                    std::to_string(base.phases(i).size()),
                    format_text("%.2f m/s", recordings::mean_speed_m_s(clip)),
                    clip.loops ? "yes" : "no",
                    joined_tags(clip),
                    std::to_string(recordings::clip_bytes(clip))});
  }
  return table_text(rows);
}

BaseJson base_json(const engine::MotionBase& base) {
  const PostureLayout& layout = base.layout();
  const auto knots = [](const auto& at) {
    BaseJson out = BaseJson::array();
    for (const float place : at) out.push_back(short_number(place));
    return out;
  };
  BaseJson clips = BaseJson::array();
  for (std::size_t i = 0; i < base.clips().size(); ++i) {
    clips.push_back(base_clip_json(base, i));
  }
  return {{"clips", std::move(clips)},
          {"layout",
           {{"abdomen", knots(layout.abdomen_at)},
            {"torso", knots(layout.torso_at)},
            {"neck", knots(layout.neck_at)}}}};
}

}  // namespace marey::app
