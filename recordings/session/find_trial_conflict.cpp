// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/session/find_trial_conflict.h"

#include <algorithm>
#include <string>

#include "core/base/in_quotes.h"
#include "recordings/base/text_reader.h"

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

bool same_frames(const Trial& a, const Trial& b) {
  if (a.frames.has_value() != b.frames.has_value()) return false;
  return !a.frames ||
         (a.frames->first == b.frames->first && a.frames->last == b.frames->last);
}

/// A floor trial may be cut out of the calibration's videos. A later check detects
/// exchanged cameras there from their detections.
bool may_share_videos(const Trial& a, const Trial& b) {
  const auto is = [&](TrialKind kind) { return a.kind == kind || b.kind == kind; };
  return is(TrialKind::kCalibration) && is(TrialKind::kFloor);
}

/// Detects videos of an earlier trial: a line that was copied and not edited.
std::optional<TrialConflict> mistake_in_videos(const Trial& trial,
                                               const Session& session) {
  for (const Trial& earlier : session.trials) {
    if (may_share_videos(trial, earlier)) continue;
    for (const TrialVideo& video : trial.videos) {
      const auto twin = std::ranges::find(earlier.videos, video.path, &TrialVideo::path);
      if (twin == earlier.videos.end()) continue;
      const std::string file = in_quotes(video.path.filename().string());
      if (twin->camera != video.camera) {
        return TrialConflict{"videos",
                             "trial " + in_quotes(earlier.name) + " has the video " +
                                 file + " for another camera",
                             "give both trials the videos of the same camera"};
      }
      if (!same_frames(trial, earlier)) continue;
      return TrialConflict{
          "videos",
          "trial " + in_quotes(earlier.name) + " has the same frames of " + file,
          "name this trial's own videos; where one video holds several "
          "trials, give each of them its frames = [FIRST, LAST]"};
    }
  }
  return std::nullopt;
}

std::optional<TrialConflict> mistake_in_slow_motion(const Trial& trial) {
  if (trial.slow_motion == 1.0) return std::nullopt;
  if (!trial.rate) {
    return TrialConflict{
        "slow_motion",
        "\"slow_motion\" has no \"fps\" in the same trial",
        "add the rate at which the camera took the pictures: for 120 pictures per second "
        "that play at 30, fps = 120 and slow_motion = 4"};
  }
  if (trial.timestamps) {
    return TrialConflict{
        "slow_motion",
        "\"slow_motion\" and \"timestamps\" exclude each other",
        "remove \"slow_motion\": the table states when frames were taken"};
  }
  return std::nullopt;
}

}  // namespace

std::optional<TrialConflict> find_trial_conflict(const Trial& trial,
                                                 const Session& session) {
  if (auto mistake = mistake_in_slow_motion(trial)) return mistake;
  if (trial.kind == TrialKind::kMotion) return mistake_in_videos(trial, session);
  if (const Trial* twin = session.find(trial.kind)) {
    return TrialConflict{"kind",
                         "trial " + in_quotes(twin->name) + " already has the kind " +
                             in_quotes(std::string(name(trial.kind))),
                         "keep the better one: only motion trials can be many"};
  }
  if (auto mistake = mistake_in_videos(trial, session)) return mistake;
  if (trial.kind != TrialKind::kFloor || trial.frames) return std::nullopt;
  const Trial* waved = session.find(TrialKind::kCalibration);
  if (!waved || waved->frames || !share_a_video(trial, *waved)) return std::nullopt;
  return TrialConflict{"kind",
                       "trial " + in_quotes(trial.name) +
                           " is the whole of a video of trial " + in_quotes(waved->name) +
                           ", in which the board moves",
                       "give the frames in which it lies on the floor: frames = [0, 30]"};
}

}  // namespace marey::recordings
