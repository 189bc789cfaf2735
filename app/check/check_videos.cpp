// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/check/check_videos.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "capture/sync/number_gaps.h"
#include "capture/video/frame_source.h"
#include "capture/video/image_folder.h"
#include "capture/video/open_frames.h"
#include "capture/video/video_file.h"
#include "core/base/parallel.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using recordings::Session;
using recordings::Trial;
using recordings::TrialKind;
using recordings::TrialVideo;

/// Video of a trial, with the contents of its header.
struct Opened {
  const Trial* trial = nullptr;
  const TrialVideo* video = nullptr;
  std::optional<capture::StreamInfo> info;
  std::optional<Error> trouble;
  std::optional<capture::NumberGap> gap;
};

std::string line_of(const Session& session, int line) {
  return session.file.string() + ":" + std::to_string(line);
}

bool is_folder(const TrialVideo& video) {
  const auto kind = capture::recording_kind(video.path, video.path.string());
  return kind && *kind == capture::RecordingKind::kImageFolder;
}

void open(Opened& one) {
  const auto source = capture::open_frames(one.video->path);
  if (!source) {
    one.trouble = source.error();
    return;
  }
  one.info = (*source)->info();
  if (has_times_file(*one.trial) || !is_folder(*one.video)) return;
  const auto images = capture::list_images(one.video->path, one.video->path.string());
  if (images) one.gap = capture::find_number_gap(*images);
}

std::vector<Opened> open_all(const Session& session) {
  std::vector<Opened> all;
  for (const Trial& trial : session.trials) {
    for (const TrialVideo& video : trial.videos) {
      std::error_code ignored;
      // A take may lack the video of a camera; find_tags() handles this case.
      if (trial.is_recorded && !fs::exists(video.path, ignored)) continue;
      all.push_back({&trial, &video, {}, {}, {}});
    }
  }
  in_parallel(all.size(), 0, [&](std::size_t i) { open(all[i]); });
  return all;
}

/// Checks that the videos can be opened. A motion passes if at least two of its videos
/// can.
Status check_opened(const std::vector<Opened>& all, std::vector<Finding>& findings) {
  std::map<const Trial*, int> readable;
  for (const Opened& one : all) readable[one.trial] += one.trouble ? 0 : 1;
  for (const Opened& one : all) {
    if (!one.trouble) continue;
    if (one.trial->kind != TrialKind::kMotion || readable[one.trial] < 2) {
      return *one.trouble;
    }
    findings.push_back(tolerated(Severity::kFair, "unreadable", *one.trouble));
  }
  return Done{};
}

/// Checks that a video has the frames of the trial. Containers other than MP4 state their
/// number to within 2 frames or 2 %, so only frames beyond that are errors.
Status check_range(const Session& session, const Opened& one) {
  const Trial& trial = *one.trial;
  if (!trial.frames || has_times_file(trial) || !one.info || !one.info->expected_frames) {
    return Done{};
  }
  const int frames = *one.info->expected_frames;
  const bool is_exact = is_folder(*one.video) || capture::is_mp4(one.video->path);
  const int max_frames = is_exact ? frames : frames + std::max(2, frames / 50);
  if (trial.frames->last < max_frames) return Done{};
  return bad_input(line_of(session, trial.line),
                   "frames " + std::to_string(trial.frames->first) + " to " +
                       std::to_string(trial.frames->last) + " of trial " + trial.name +
                       " do not all exist: " + one.info->name + " has only " +
                       std::to_string(frames) + " (numbers 0 to " +
                       std::to_string(frames - 1) + ")",
                   "correct `frames` of that trial, or its `videos`");
}

Status check_gap(const Opened& one) {
  if (!one.gap) return Done{};
  const std::string more =
      one.gap->gaps > 1
          ? " (and " + std::to_string(one.gap->gaps - 1) + " more such gaps)"
          : std::string();
  return bad_input(one.video->path.string(),
                   std::to_string(one.gap->missing) + " images are missing between " +
                       one.gap->before + " and " + one.gap->after + more +
                       ": all later frames would get numbers that are too small",
                   "copy the missing images there; if the camera never took them, give "
                   "the trial `timestamps`, or number the images without gaps");
}

std::string size_of(const capture::StreamInfo& info) {
  return std::to_string(info.width_px) + " x " + std::to_string(info.height_px);
}

/// Compares picture size and rotation mark of two videos of one camera.
Status compare(const capture::StreamInfo& earlier, const capture::StreamInfo& info) {
  if (earlier.turned_deg != info.turned_deg) {
    return bad_input(info.name,
                     "its rotation mark turns its pictures by " +
                         std::to_string(info.turned_deg) + " degrees, that of " +
                         earlier.name + ", from the same camera, by " +
                         std::to_string(earlier.turned_deg),
                     "a calibration is valid for one orientation: remove the mark from "
                     "the file, or record all trials of a camera in one orientation");
  }
  if (size_of(earlier) == size_of(info)) return Done{};
  const bool is_on_its_side =
      earlier.width_px == info.height_px && earlier.height_px == info.width_px;
  return bad_input(
      info.name,
      "its pictures are " + size_of(info) + ", but those of " + earlier.name +
          ", from the same camera, are " + size_of(earlier) +
          (is_on_its_side ? ": one of them is on its side" : ""),
      is_on_its_side
          ? "turn that video back by a quarter, or record all trials of a camera the "
            "same way round"
          : "record all trials of a camera with the same picture size");
}

}  // namespace

Status check_videos(const Session& session, std::vector<Finding>& findings) {
  for (const Trial& trial : session.trials) {
    std::error_code ignored;
    if (!trial.timestamps || fs::exists(*trial.timestamps, ignored)) continue;
    return bad_input(
        line_of(session, trial.line),
        "trial " + trial.name + ": " + trial.timestamps->string() + " does not exist",
        "correct `timestamps` of that trial, or leave it out");
  }
  const std::vector<Opened> all = open_all(session);
  if (const Status ok = check_opened(all, findings); !ok) return ok;
  std::map<CameraId, const capture::StreamInfo*> of_camera;
  for (const Opened& one : all) {
    if (!one.info) continue;
    if (const Status ok = check_range(session, one); !ok) return ok;
    if (const Status ok = check_gap(one); !ok) return ok;
    const auto [earlier, is_first] = of_camera.try_emplace(one.video->camera, &*one.info);
    if (is_first) continue;
    if (const Status ok = compare(*earlier->second, *one.info); !ok) return ok;
  }
  return Done{};
}

void assess_video_lengths(const Session& session,
                          const Trial& trial,
                          const std::vector<CameraDetections>& found,
                          std::vector<Finding>& findings) {
  constexpr double kMinShortfall_s = 0.5;
  constexpr double kMinShortfallShare = 0.05;
  if (trial.kind == TrialKind::kCalibration || trial.kind == TrialKind::kFloor ||
      has_times_file(trial)) {
    return;
  }
  std::size_t max_frames = 0;
  for (const CameraDetections& camera : found)
    max_frames = std::max(max_frames, camera.frames.size());
  for (const TrialVideo& video : trial.videos) {
    const CameraDetections& camera = found[index(video.camera)];
    if (camera.frames.empty() || camera.broken_off) continue;
    const auto missing = static_cast<double>(max_frames - camera.frames.size());
    if (missing <= kMinShortfall_s * camera.rate.hz ||
        missing <= kMinShortfallShare * static_cast<double>(max_frames)) {
      continue;
    }
    findings.push_back(fair_finding(
        "short",
        camera.source,
        "it has " + std::to_string(camera.frames.size()) +
            " frames, another video of trial " + trial.name + " has " +
            std::to_string(max_frames) + ": later frames are solved without camera " +
            session.cameras[index(video.camera)],
        "copy the file again; if it was cut at its beginning, cut the others there too"));
  }
}

}  // namespace marey::app
