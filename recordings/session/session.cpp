// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/session/session.h"

#include <algorithm>
#include <system_error>

#include "core/base/assert.h"
#include "core/base/in_quotes.h"
#include "core/base/name_pattern.h"
#include "recordings/base/text_reader.h"
#include "recordings/base/toml_reader.h"
#include "recordings/takes/take_file.h"

namespace marey::recordings {
namespace {

bool is_there(const TrialVideo& video) {
  const bool many = is_name_pattern(video.path);
  std::error_code ignored;
  return std::filesystem::exists(many ? video.path.parent_path() : video.path, ignored);
}

}  // namespace

std::string_view name(TrialKind kind) {
  switch (kind) {
    case TrialKind::kCalibration:
      return "calibration";
    case TrialKind::kFloor:
      return "floor";
    case TrialKind::kStatic:
      return "static";
    case TrialKind::kRangeOfMotion:
      return "range-of-motion";
    case TrialKind::kMotion:
      return "motion";
  }
  return "motion";
}

const std::string& Session::family_of(TagId id) const {
  for (const TagFamilyUse& use : families) {
    if (std::find(use.ids.begin(), use.ids.end(), id) != use.ids.end()) return use.name;
  }
  MAREY_ASSERT(false);
  return families.front().name;
}

const Trial* Session::find(TrialKind kind) const {
  for (const Trial& trial : trials) {
    if (trial.kind == kind) return &trial;
  }
  return nullptr;
}

const Trial* Session::find(std::string_view trial_name) const {
  for (const Trial& trial : trials) {
    if (trial.name == trial_name) return &trial;
  }
  return nullptr;
}

bool has_recording(const Trial& trial) {
  std::error_code ignored;
  const auto folder = trial.videos.front().path.parent_path();
  return std::filesystem::exists(folder / kTakeFile, ignored) ||
         std::any_of(trial.videos.begin(), trial.videos.end(), [&](const auto& video) {
           return std::filesystem::exists(video.path, ignored);
         });
}

bool has_video(const Trial& trial) {
  return std::any_of(trial.videos.begin(), trial.videos.end(), is_there);
}

Status check_files(const Session& session) {
  for (const Trial& trial : session.trials) {
    if (trial.is_recorded) {
      if (has_recording(trial)) continue;
      return bad_input(file_and_line(session.file.string(), trial.line),
                       "trial " + in_quotes(trial.name) + " is not recorded yet",
                       "marey record SESSION --out FOLDER --trial " + trial.name +
                           ", and process that folder; or name the trial's videos");
    }
    for (const TrialVideo& video : trial.videos) {
      if (is_there(video)) continue;
      return bad_input(
          file_and_line(session.file.string(), video.line),
          "trial " + trial.name + ": " + video.path.string() + " does not exist",
          "copy the video there, or correct its path or `media`");
    }
  }
  return Done{};
}

}  // namespace marey::recordings
