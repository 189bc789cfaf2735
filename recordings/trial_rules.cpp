// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/trial_rules.h"

#include "recordings/text_reader.h"

namespace marey::recordings {
namespace {

bool share_a_video(const Trial& a, const Trial& b) {
  for (const TrialVideo& video : a.videos) {
    for (const TrialVideo& other : b.videos) {
      if (video.path == other.path) return true;
    }
  }
  return false;
}

}  // namespace

std::optional<TrialMistake> mistake_of(const Trial& trial, const Session& session) {
  if (trial.kind == TrialKind::kMotion) return std::nullopt;
  if (const Trial* twin = session.find(trial.kind)) {
    return TrialMistake{"kind",
                        "trial " + in_quotes(twin->name) + " already has the kind " +
                            in_quotes(std::string(name(trial.kind))),
                        "keep the better one: only motion trials can be many"};
  }
  if (trial.kind != TrialKind::kFloor || trial.frames) return std::nullopt;
  const Trial* waved = session.find(TrialKind::kCalibration);
  if (!waved || waved->frames || !share_a_video(trial, *waved)) return std::nullopt;
  return TrialMistake{"kind",
                      "trial " + in_quotes(trial.name) +
                          " is the whole of a video of trial " + in_quotes(waved->name) +
                          ", in which the board moves",
                      "say in which frames it lies on the floor: frames = [0, 30]"};
}

}  // namespace marey::recordings
