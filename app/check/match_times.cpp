// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/check/match_times.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <system_error>
#include <utility>

#include "app/check/check_frame_times.h"
#include "capture/sync/align_frames.h"
#include "core/base/assert.h"
#include "core/base/format_text.h"
#include "core/base/frame_range.h"
#include "recordings/takes/frame_stamps.h"
#include "recordings/takes/take_file.h"

namespace marey::app {
namespace {

using recordings::Take;
using recordings::TakeCamera;
using recordings::Trial;
using recordings::TrialVideo;

std::filesystem::path take_file_of(const TrialVideo& video) {
  return video.path.parent_path() / recordings::kTakeFile;
}

/// Renumbers the frames of a camera by `aligned`, and keeps those of `range`.
/// Precondition: `aligned` covers the range.
void renumber(const capture::AlignedCamera& aligned,
              const std::optional<FrameRange>& range,
              CameraDetections& camera) {
  const int all = static_cast<int>(aligned.recorded.size());
  const int first = range ? range->first : 0;
  const int end = range ? range->last + 1 : all;
  MAREY_ASSERT(end <= all);
  std::vector<FrameDetections> frames;
  std::vector<std::optional<int>> in_recording;
  for (int k = first; k < end; ++k) {
    const auto recorded = aligned.recorded[static_cast<std::size_t>(k)];
    FrameDetections& frame = frames.emplace_back();
    if (recorded) {
      frame = std::move(camera.frames[static_cast<std::size_t>(*recorded)]);
    }
    frame.frame = k;
    in_recording.push_back(recorded);
  }
  camera.frames = std::move(frames);
  camera.in_recording = std::move(in_recording);
}

/// Returns the number of frames that are in the video and in the file of the take. The
/// two differ if the recording was cut off in its last moments, or if the video is
/// incomplete; the second is a poor finding.
std::size_t usable_frames(const Take& take,
                          const TakeCamera& recorded,
                          const CameraDetections& camera,
                          std::vector<Finding>& findings) {
  const std::size_t seen = camera.frames.size();
  const std::size_t timed = recorded.frames.size();
  if (take.finished && seen < timed && !camera.broken_off) {
    findings.push_back(
        tolerated(Severity::kPoor,
                  "short",
                  bad_input(camera.source,
                            "the video ends after " + std::to_string(seen) + " of the " +
                                std::to_string(timed) + " frames that were recorded",
                            "copy the file again from where it was recorded")));
  }
  return std::min(seen, timed);
}

const TakeCamera* find_camera(const Take& take, const TrialVideo& video) {
  const std::string file = video.path.filename().string();
  const auto found =
      std::find_if(take.cameras.begin(), take.cameras.end(), [&](const TakeCamera& c) {
        return c.file == file || c.file == video.path.string();
      });
  return found == take.cameras.end() ? nullptr : &*found;
}

void report_losses(const TakeCamera& recorded,
                   const CameraDetections& camera,
                   const capture::AlignedCamera& aligned,
                   FrameRate rate,
                   std::vector<Finding>& findings) {
  std::int64_t dropped = 0;
  for (const recordings::TakeFrame& frame : recorded.frames) {
    dropped += frame.dropped_before;
  }
  const auto frames = static_cast<std::int64_t>(recorded.frames.size());
  // Up to 1 % of dropped frames is normal; they are bridged like hidden frames.
  if (dropped > frames / 100) {
    findings.push_back(fair_finding("dropped",
                                    camera.source,
                                    std::to_string(dropped) +
                                        " frames were dropped while recording, and " +
                                        std::to_string(frames) + " recorded"));
  }
  if (aligned.surplus > 0) {
    findings.push_back(fair_finding(
        "surplus",
        camera.source,
        format_text("%d frames are left out: the camera took them between two instants "
                    "of the others",
                    aligned.surplus)));
  }
  // In 0.01 s the fastest limb of a person moves by 3 cm.
  const double spread_s = seconds(aligned.spread);
  if (spread_s > 0.01 || spread_s > 0.25 / rate.hz) {
    findings.push_back(fair_finding(
        "uneven",
        camera.source,
        format_text("its frames are up to %.1f ms away from a steady rate of %.2f Hz",
                    1e3 * spread_s,
                    rate.hz)));
  }
}

/// Returns the longest time between two successive frames, as text for a message.
std::string max_gap_text(const std::vector<capture::CameraTimes>& cameras,
                         const std::vector<const TakeCamera*>& recorded) {
  Timestamp longest{-1};
  std::string text;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    const std::vector<Timestamp>& times = cameras[c].times;
    for (std::size_t i = 1; i < times.size(); ++i) {
      if (times[i] - times[i - 1] <= longest) continue;
      longest = times[i] - times[i - 1];
      text = format_text("frame %zu of %s comes %.1f s after the previous one",
                         i,
                         recorded[c]->file.c_str(),
                         seconds(longest));
    }
  }
  return text;
}

/// Returns the reason why align_frames() failed.
Error unusable_times(const std::filesystem::path& file,
                     const std::vector<capture::CameraTimes>& cameras,
                     const std::vector<const TakeCamera*>& recorded) {
  const auto has_rate = [](const capture::CameraTimes& c) {
    return capture::measured_rate(c.times).has_value();
  };
  if (std::none_of(cameras.begin(), cameras.end(), has_rate)) {
    return bad_input(
        file.string(), "it has too few frames to be used", "record the trial again");
  }
  return bad_input(
      file.string(),
      "its times span too long for the number of frames: " +
          max_gap_text(cameras, recorded),
      "record the trial again; or name the videos in the trial's `videos`, "
      "elsewhere than in the take: then frames are matched by their numbers");
}

Status check_range(const Trial& trial,
                   const std::filesystem::path& file,
                   const capture::FrameAlignment& alignment) {
  const std::size_t instants = alignment.cameras.front().recorded.size();
  if (!trial.frames || static_cast<std::size_t>(trial.frames->last) < instants) {
    return Done{};
  }
  return bad_input(file.string(),
                   "frames " + std::to_string(trial.frames->first) + " to " +
                       std::to_string(trial.frames->last) +
                       " are beyond its end: it has only " + std::to_string(instants),
                   "correct the trial's range of frames");
}

/// Reads the table of times that the session names, as a take with these times.
Result<Take> read_stamped(const Trial& trial,
                          const std::vector<CameraDetections>& found) {
  std::vector<std::string> videos;
  for (const TrialVideo& video : trial.videos) {
    videos.push_back(video.path.stem().string());
  }
  const auto stamps = recordings::read_frame_stamps(*trial.timestamps, videos);
  if (!stamps) return stamps.error();
  Take take;
  take.trial = trial.name;
  take.finished = true;
  for (std::size_t i = 0; i < trial.videos.size(); ++i) {
    const TrialVideo& video = trial.videos[i];
    const CameraDetections& camera = found[index(video.camera)];
    const std::vector<Timestamp>& times = (*stamps)[i];
    if (!camera.frames.empty() && !camera.broken_off &&
        camera.frames.size() != times.size()) {
      return bad_input(trial.timestamps->string(),
                       "it has " + std::to_string(times.size()) + " times for " +
                           camera.source +
                           ", which has frames: " + std::to_string(camera.frames.size()),
                       "name the table that was written with this video");
    }
    TakeCamera& one = take.cameras.emplace_back();
    one.file = video.path.string();
    for (const Timestamp time : times) one.frames.emplace_back().time = time;
  }
  return take;
}

Status match_take(const Trial& trial,
                  std::vector<CameraDetections>& found,
                  std::vector<Finding>& findings) {
  const auto file =
      trial.timestamps ? *trial.timestamps : take_file_of(trial.videos.front());
  const Result<Take> take =
      trial.timestamps ? read_stamped(trial, found) : recordings::read_take(file);
  if (!take) return take.error();
  if (!take->finished) {
    findings.push_back(
        fair_finding("cut-off",
                     file.string(),
                     "the recording was cut off; what was recorded until then is used"));
  }
  std::vector<capture::CameraTimes> times;
  std::vector<const TakeCamera*> recorded;
  for (const TrialVideo& video : trial.videos) {
    CameraDetections& camera = found[index(video.camera)];
    if (camera.frames.empty()) continue;
    const TakeCamera* one = find_camera(*take, video);
    if (one == nullptr) {
      return bad_input(file.string(),
                       "it has no entry for " + video.path.filename().string(),
                       "give the videos the names that they had when they were recorded");
    }
    capture::CameraTimes& stamps = times.emplace_back();
    stamps.camera = video.camera;
    const std::size_t usable = usable_frames(*take, *one, camera, findings);
    for (std::size_t i = 0; i < usable; ++i) stamps.times.push_back(one->frames[i].time);
    recorded.push_back(one);
  }
  if (times.empty()) return Done{};
  const auto alignment = capture::align_frames(times, trial.rate);
  if (!alignment) return unusable_times(file, times, recorded);
  if (const Status ok = check_range(trial, file, *alignment); !ok) return ok;
  for (std::size_t i = 0; i < alignment->cameras.size(); ++i) {
    const capture::AlignedCamera& aligned = alignment->cameras[i];
    CameraDetections& camera = found[index(aligned.camera)];
    renumber(aligned, trial.frames, camera);
    camera.rate = alignment->rate;
    camera.offset = camera.offset.value_or(Timestamp{0}) + aligned.offset;
    report_losses(*recorded[i], camera, aligned, alignment->rate, findings);
  }
  return Done{};
}

/// Warns of a file of a take that is not used. Such a file covers only some of the
/// videos, if they lie in several folders.
void warn_of_unused_take(const Trial& trial, std::vector<Finding>& findings) {
  for (const TrialVideo& video : trial.videos) {
    std::error_code ignored;
    const auto file = take_file_of(video);
    if (!std::filesystem::exists(file, ignored)) continue;
    findings.push_back(fair_finding("unused",
                                    file.string(),
                                    "it is not used, since the videos of trial " +
                                        trial.name + " lie in several folders"));
    return;
  }
}

}  // namespace

bool has_times_file(const Trial& trial) {
  const auto file = take_file_of(trial.videos.front());
  const auto has_same_file = [&](const TrialVideo& v) { return take_file_of(v) == file; };
  std::error_code ignored;
  return trial.is_recorded || trial.timestamps ||
         (std::all_of(trial.videos.begin(), trial.videos.end(), has_same_file) &&
          std::filesystem::exists(file, ignored));
}

Status match_times(const Trial& trial,
                   std::vector<CameraDetections>& found,
                   std::vector<Finding>& findings) {
  if (has_times_file(trial) && trial.slow_motion != 1.0) {
    return bad_input(take_file_of(trial.videos.front()).string(),
                     "it states when the frames of trial " + trial.name +
                         " were taken, so that slow_motion has no meaning",
                     "remove slow_motion of that trial from session.toml");
  }
  if (has_times_file(trial)) return match_take(trial, found, findings);
  warn_of_unused_take(trial, findings);
  if (trial.rate || trial.frames) return check_frame_times(trial, found, findings);
  std::vector<capture::CameraTimes> uneven;
  std::optional<FrameRate> steady;
  for (const TrialVideo& video : trial.videos) {
    const CameraDetections& camera = found[index(video.camera)];
    if (camera.frames.empty()) continue;
    auto own = find_uneven_video(video, camera.rate);
    if (!own && !steady) steady = camera.rate;
    if (!own) continue;
    const bool usable =
        own->own.times.size() == camera.frames.size() + camera.frames.front().frame &&
        !capture::reach_too_far(std::span(&own->own, 1), camera.rate);
    findings.push_back(
        fair_finding("uneven",
                     camera.source,
                     describe_uneven_video(*own, camera.rate) + "; " +
                         (usable ? "its own times are used"
                                 : "its frames are matched by their numbers")));
    if (usable) uneven.push_back(std::move(own->own));
  }
  for (const capture::CameraTimes& times : uneven) {
    CameraDetections& camera = found[index(times.camera)];
    if (!steady) steady = camera.rate;
    const auto alignment = capture::align_frames(std::span(&times, 1), steady);
    if (!alignment) {
      findings.push_back(fair_finding(
          "uneven",
          camera.source,
          "its times contradict its rate; its frames are matched by their numbers"));
      continue;
    }
    renumber(alignment->cameras.front(), std::nullopt, camera);
    camera.rate = *steady;
  }
  return Done{};
}

}  // namespace marey::app
