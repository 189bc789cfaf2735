// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/process/find_tags.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <variant>

#include "app/check/check_sights.h"
#include "app/check/check_videos.h"
#include "capture/search/detect_videos.h"
#include "core/base/assert.h"
#include "recordings/session/detections_file.h"
#include "recordings/text/content_key.h"

namespace marey::app {
namespace {

using recordings::Trial;
using recordings::TrialVideo;

/// Returns the tags to detect. If the session has one family, all of its tags are
/// detected, since tags that the session does not list show errors in it.
std::vector<TagFamilyUse> families_to_find(const recordings::Session& session) {
  if (session.families.size() == 1) return {{session.families.front().name, {}}};
  return session.families;
}

Wanted wanted_in(const recordings::Session& session, const Trial& trial) {
  Wanted wanted;
  if (!session.families.empty()) wanted.families = families_to_find(session);
  const bool shows_target = trial.kind == recordings::TrialKind::kCalibration ||
                            trial.kind == recordings::TrialKind::kFloor;
  if (shows_target && has_points(session.target)) wanted.target = session.target;
  wanted.shows_grid = shows_target && std::holds_alternative<AprilGrid>(session.target);
  if (wanted.shows_grid && trial.kind == recordings::TrialKind::kCalibration) {
    wanted.grid = std::get<AprilGrid>(session.target);
  }
  return wanted;
}

/// Returns all parameters that the detection of points depends on, for the cache key.
std::string cache_words(const CalibrationTarget& target) {
  std::string words;
  if (const auto* board = std::get_if<CharucoBoard>(&target)) {
    words.append(" charuco-1 ").append(board->dictionary);
    if (board->is_legacy) words.append(" legacy");
    if (board->is_inverted) words.append(" inverted");
    if (board->is_two_sided) words.append(" two-sided");
    words.append(" ").append(std::to_string(board->marker_size_m / board->square_size_m));
    words.append(" ").append(std::to_string(board->columns));
    words.append("x").append(std::to_string(board->rows));
  } else if (const auto* chess = std::get_if<Chessboard>(&target)) {
    words.append(" chessboard-1 ").append(std::to_string(chess->columns));
    words.append("x").append(std::to_string(chess->rows));
  }
  return words;
}

std::string cache_words(const std::vector<TagFamilyUse>& families) {
  std::string words;
  for (const TagFamilyUse& use : families) {
    words.append(" ").append(use.name);
    for (const TagId id : use.ids) words.append(",").append(std::to_string(number(id)));
  }
  return words;
}

/// Returns a key of everything that a cached detection depends on.
Result<std::string> cache_key(const TrialVideo& video,
                              const Trial& trial,
                              const Wanted& wanted) {
  const auto content = recordings::content_key(video.path);
  if (!content) return content.error();
  // Increase the number if the detector finds other corners in the same picture.
  std::string key = *content;
  if (!wanted.families.empty()) key += " tracker-2" + cache_words(wanted.families);
  if (wanted.target) key += cache_words(*wanted.target);
  if (trial.frames && !has_take(trial)) {
    key += " frames " + std::to_string(trial.frames->first) + "-" +
           std::to_string(trial.frames->last);
  }
  if (trial.rate) key += " fps " + std::to_string(trial.rate->hz);
  return key;
}

/// Returns an error if the take lacks the video of a camera.
std::optional<Error> lost_video(const recordings::Session& session,
                                const Trial& trial,
                                const TrialVideo& video) {
  std::error_code ignored;
  if (!trial.is_recorded || std::filesystem::exists(video.path, ignored)) {
    return std::nullopt;
  }
  return bad_input(video.path.string(),
                   "trial " + trial.name + " has no recording of camera \"" +
                       session.cameras[index(video.camera)] + "\"",
                   "copy it from where the trial was recorded, or record again");
}

/// Reports videos that could not be read to the end. A motion needs at least two cameras
/// with frames; in other trials every camera needs frames.
Status report_broken_videos(const Trial& trial,
                            const std::vector<CameraDetections>& found,
                            RecordingTroubles& troubles) {
  const bool is_motion = trial.kind == recordings::TrialKind::kMotion;
  std::ptrdiff_t cameras = 0;
  for (const CameraDetections& camera : found) {
    if (!camera.frames.empty()) ++cameras;
    if (camera.damaged_frames > 0) {
      troubles.warnings.push_back(camera.source + ": " +
                                  std::to_string(camera.damaged_frames) + " of " +
                                  std::to_string(camera.frames.size()) +
                                  " frames are damaged and count as empty");
    }
    if (!camera.broken_off) continue;
    if (camera.frames.empty() && !is_motion) return *camera.broken_off;
    troubles.failures.push_back(*camera.broken_off);
  }
  if (cameras >= 2 || troubles.failures.empty() || (cameras == 1 && !is_motion)) {
    return Done{};
  }
  return troubles.failures.back();
}

/// Checks that an offset is at most two frames: offsets are corrected as motion between
/// frames, not by skipping frames.
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

/// Checks that all videos of a trial have one rate, as frames are matched by number.
/// Passes for a calibration trial whose clocks are estimated. Sets this rate for cameras
/// without a video in the trial. Precondition: at least one camera has frames.
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

/// Detects tags and boards in the videos that have no cached detections.
Result<std::vector<CameraDetections>> detect(
    const recordings::Session& session,
    const Trial& trial,
    const std::vector<capture::CameraInput>& missing,
    const Wanted& wanted,
    Console& console) {
  if (const Status ok = check_board(session, missing, wanted.target); !ok) {
    return ok.error();
  }
  capture::DetectVideosOptions detector;
  detector.find_tags = !wanted.families.empty();
  if (detector.find_tags) detector.tracker.detector.families = wanted.families;
  detector.target = wanted.target;
  detector.keep_broken = true;
  return capture::detect_tags_in_videos(
      missing,
      detector,
      console.stage((wanted.target ? "board in " : "tags in ") + trial.name));
}

}  // namespace

Result<std::vector<CameraDetections>> find_tags(const recordings::Session& session,
                                                const Trial& trial,
                                                const std::filesystem::path& out,
                                                Console& console,
                                                RecordingTroubles& troubles) {
  const auto folder = out / trial.name / "detections";
  std::vector<CameraDetections> found(session.cameras.size());
  for (std::size_t c = 0; c < found.size(); ++c) {
    found[c].camera = CameraId{static_cast<int>(c)};
  }
  const Wanted wanted = wanted_in(session, trial);
  std::vector<capture::CameraInput> missing;
  std::map<CameraId, std::string> keys;
  for (const TrialVideo& video : trial.videos) {
    if (const auto lost = lost_video(session, trial, video)) {
      if (trial.kind != recordings::TrialKind::kMotion) return *lost;
      troubles.failures.push_back(*lost);
      continue;
    }
    const auto key = cache_key(video, trial, wanted);
    if (!key) return key.error();
    keys[video.camera] = *key;
    const auto file = folder / (session.cameras[index(video.camera)] + ".csv");
    auto cached = recordings::read_detections(file, *key);
    // A cache that cannot be read is computed again.
    if (cached && *cached) {
      found[index(video.camera)] = std::move(**cached);
      continue;
    }
    capture::CameraInput input;
    input.path = video.path;
    input.camera = video.camera;
    if (trial.frames && !has_take(trial))
      input.range = {trial.frames->first, trial.frames->last};
    input.rate = trial.rate;  // A folder of images has no other.
    missing.push_back(std::move(input));
  }
  if (!missing.empty()) {
    auto made = detect(session, trial, missing, wanted, console);
    if (!made) return made.error();
    for (CameraDetections& camera : *made) {
      const auto file = folder / (session.cameras[index(camera.camera)] + ".csv");
      if (!camera.broken_off) {
        const Status written =
            recordings::write_detections(file, camera, keys[camera.camera]);
        if (!written) return written.error();
      }
      found[index(camera.camera)] = std::move(camera);
    }
  }
  if (const Status ok = report_broken_videos(trial, found, troubles); !ok)
    return ok.error();
  for (const TrialVideo& video : trial.videos) {
    CameraDetections& camera = found[index(video.camera)];
    if (camera.frames.empty()) continue;
    camera.camera = video.camera;
    camera.source = video.path.string();
    camera.offset = video.offset;
    if (trial.rate) camera.rate = *trial.rate;
    const bool is_floor = trial.kind == recordings::TrialKind::kFloor;
    if (const Status ok =
            is_floor ? Status(Done{}) : check_seen(session, trial, camera, wanted);
        !ok) {
      return ok.error();
    }
    if (const Status ok = check_offset(session, video, camera.rate); !ok) {
      return ok.error();
    }
  }
  if (trial.kind == recordings::TrialKind::kFloor) {
    const Status ok = check_floor_seen(session, trial, found, wanted, troubles);
    if (!ok) return ok.error();
  }
  warn_of_short_videos(session, trial, found, troubles);
  if (const Status ok = match_times(trial, found, troubles); !ok) return ok.error();
  if (const Status ok = check_rates(session, trial, found); !ok) return ok.error();
  return found;
}

void take_off_shrinkage(std::span<const Camera> cameras,
                        std::vector<CameraDetections>& detections) {
  for (CameraDetections& camera : detections) {
    const TagShrinkage& shrinkage = cameras[index(camera.camera)].tag_shrinkage;
    for (FrameDetections& frame : camera.frames) {
      for (TagDetection& tag : frame.tags) {
        tag.corners_px = unshrunk(tag.corners_px, shrinkage);
      }
    }
  }
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
