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

std::optional<TrialMistake> mistake_in_slow_motion(const Trial& trial) {
  if (trial.slow_motion == 1.0) return std::nullopt;
  if (!trial.rate) {
    return TrialMistake{
        "slow_motion",
        "\"slow_motion\" has no \"fps\" in the same trial",
        "add the rate at which the camera took the pictures: for 120 pictures per second "
        "that play at 30, fps = 120 and slow_motion = 4"};
  }
  if (trial.timestamps) {
    return TrialMistake{
        "slow_motion",
        "\"slow_motion\" and \"timestamps\" exclude each other",
        "remove \"slow_motion\": the table states when frames were taken"};
  }
  return std::nullopt;
}

}  // namespace

std::optional<TrialMistake> mistake_of(const Trial& trial, const Session& session) {
  if (auto mistake = mistake_in_slow_motion(trial)) return mistake;
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
