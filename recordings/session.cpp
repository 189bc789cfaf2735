// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/session.h"

#include <system_error>

#include "recordings/toml_reader.h"

namespace marey::recordings {

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

Status check_files(const Session& session) {
  for (const Trial& trial : session.trials) {
    for (const TrialVideo& video : trial.videos) {
      std::error_code ignored;
      if (std::filesystem::exists(video.path, ignored)) continue;
      return bad_input(file_and_line(session.file.string(), video.line),
                       "trial " + trial.name + ": there is no " + video.path.string(),
                       "copy the video there, or correct its path or `media`");
    }
  }
  return Done{};
}

}  // namespace marey::recordings
