// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/check/check_detections.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>

#include "app/check/check_target_seen.h"
#include "core/base/assert.h"

namespace marey::app {

using recordings::Trial;
using recordings::TrialVideo;

namespace {

Status check_offset(const recordings::Session& session,
                    const TrialVideo& video,
                    FrameRate rate) {
  constexpr double kMaxFrames = 2.0;
  if (!video.offset || std::abs(seconds(*video.offset)) * rate.hz <= kMaxFrames) {
    return Done{};
  }
  return bad_input(session.file.string() + ":" + std::to_string(video.line),
                   "the time offset of camera \"" + session.cameras[index(video.camera)] +
                       "\" is more than two frames",
                   "cut the videos so that they start within one frame of each other; "
                   "marey estimates the remaining offset");
}

}  // namespace

Status check_video_exists(const recordings::Session& session,
                          const Trial& trial,
                          const TrialVideo& video) {
  std::error_code ignored;
  if (!trial.is_recorded || std::filesystem::exists(video.path, ignored)) {
    return Done{};
  }
  return bad_input(video.path.string(),
                   "trial " + trial.name + " has no recording of camera \"" +
                       session.cameras[index(video.camera)] + "\"",
                   "copy it from where the trial was recorded, or record again");
}

Status check_readable(const Trial& trial,
                      const std::vector<CameraDetections>& found,
                      std::vector<Finding>& findings) {
  const bool is_motion = trial.kind == recordings::TrialKind::kMotion;
  std::ptrdiff_t cameras = 0;
  for (const CameraDetections& camera : found) {
    if (!camera.frames.empty()) ++cameras;
    if (camera.damaged_frames > 0) {
      findings.push_back(fair_finding("damaged",
                                      camera.source,
                                      std::to_string(camera.damaged_frames) + " of " +
                                          std::to_string(camera.frames.size()) +
                                          " frames are damaged and count as empty"));
    }
    if (!camera.broken_off) continue;
    if (camera.frames.empty() && !is_motion) return *camera.broken_off;
    findings.push_back(tolerated(Severity::kPoor, "broken", *camera.broken_off));
  }
  if (cameras >= 2 || (cameras == 1 && !is_motion)) return Done{};
  // The last error explains why there are too few cameras.
  const auto last = std::find_if(findings.rbegin(), findings.rend(), [](const auto& f) {
    return f.severity == Severity::kPoor;
  });
  return last == findings.rend() ? Status(Done{}) : last->error();
}

Status check_content(const recordings::Session& session,
                     const Trial& trial,
                     const std::vector<CameraDetections>& found,
                     const ContentToDetect& wanted,
                     std::vector<Finding>& findings) {
  const bool is_floor = trial.kind == recordings::TrialKind::kFloor;
  for (const TrialVideo& video : trial.videos) {
    const CameraDetections& camera = found[index(video.camera)];
    if (camera.frames.empty()) continue;
    if (!is_floor) {
      const Status ok = check_target_seen(session, trial, camera, wanted);
      if (!ok) return ok;
    }
    if (const Status ok = check_offset(session, video, camera.rate); !ok) return ok;
  }
  if (!is_floor) return Done{};
  return check_floor_seen(session, trial, found, wanted, findings);
}

Status check_rates(const recordings::Session& session,
                   const Trial& trial,
                   std::vector<CameraDetections>& cameras) {
  const auto with_frames = std::find_if(
      cameras.begin(), cameras.end(), [](const auto& c) { return !c.frames.empty(); });
  MAREY_ASSERT(with_frames != cameras.end());
  const CameraDetections& first = *with_frames;
  for (CameraDetections& camera : cameras) {
    if (camera.frames.empty()) {
      camera.rate = first.rate;
      camera.source = session.file.string();
      continue;
    }
    if (std::abs(camera.rate.hz / first.rate.hz - 1.0) < 1e-3) continue;
    if (trial.kind == recordings::TrialKind::kCalibration &&
        session.calibration.clocks != recordings::ClockChoice::kShared) {
      continue;
    }
    std::array<char, 120> text{};
    std::snprintf(text.data(),
                  text.size(),
                  "runs at %.3f frames per second, %s at %.3f",
                  camera.rate.hz,
                  session.cameras[index(first.camera)].c_str(),
                  first.rate.hz);
    return bad_input(camera.source,
                     text.data(),
                     "record all cameras at one rate, or give the trial an fps in "
                     "session.toml if the files state it wrongly");
  }
  return Done{};
}

Status check_picture_sizes(const std::vector<CameraDetections>& earlier,
                           const std::vector<CameraDetections>& found) {
  const auto size = [](const CameraDetections& camera) {
    return std::to_string(camera.width_px) + " x " + std::to_string(camera.height_px);
  };
  for (std::size_t c = 0; c < found.size(); ++c) {
    if (earlier[c].frames.empty() || found[c].frames.empty()) continue;
    if (size(earlier[c]) == size(found[c])) continue;
    return bad_input(found[c].source,
                     "its pictures are " + size(found[c]) + ", but those of " +
                         earlier[c].source + ", from the same camera, are " +
                         size(earlier[c]),
                     "record all trials of a camera with the same picture size");
  }
  return Done{};
}

}  // namespace marey::app
