// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/process/find_tags.h"

#include <map>
#include <utility>

#include "app/check/check_detections.h"
#include "app/check/check_target_seen.h"
#include "app/check/check_videos.h"
#include "app/check/match_times.h"
#include "app/process/detection_cache.h"
#include "capture/search/detect_videos.h"

namespace marey::app {
namespace {

using recordings::Trial;
using recordings::TrialVideo;

/// Detects tags and boards in the videos that have no cached detections.
Result<std::vector<CameraDetections>> detect(
    const recordings::Session& session,
    const Trial& trial,
    const std::vector<capture::CameraInput>& missing,
    const ContentToDetect& wanted,
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

capture::CameraInput input_of(const Trial& trial, const TrialVideo& video) {
  capture::CameraInput input;
  input.path = video.path;
  input.camera = video.camera;
  if (trial.frames && !has_times_file(trial)) {
    input.range = trial.frames;
  }
  input.rate = trial.rate;  // A folder of images has no other.
  return input;
}

/// Returns the detections of all cameras of the session: those of the cache, and computed
/// ones, which it writes there. A motion without some of its videos passes.
Result<std::vector<CameraDetections>> read_or_detect(const recordings::Session& session,
                                                     const Trial& trial,
                                                     const ContentToDetect& wanted,
                                                     const std::filesystem::path& out,
                                                     Console& console,
                                                     std::vector<Finding>& findings) {
  std::vector<CameraDetections> found(session.cameras.size());
  for (std::size_t c = 0; c < found.size(); ++c) {
    found[c].camera = CameraId{static_cast<int>(c)};
  }
  std::vector<capture::CameraInput> inputs;
  std::map<CameraId, DetectionCache> caches;
  for (const TrialVideo& video : trial.videos) {
    if (const Status exists = check_video_exists(session, trial, video); !exists) {
      if (trial.kind != recordings::TrialKind::kMotion) return exists.error();
      findings.push_back(tolerated(Severity::kPoor, "missing", exists.error()));
      continue;
    }
    const auto cache = DetectionCache::open(session, trial, video, wanted, out);
    if (!cache) return cache.error();
    if (auto cached = cache->read()) {
      found[index(video.camera)] = std::move(*cached);
      continue;
    }
    caches.insert_or_assign(video.camera, *cache);
    inputs.push_back(input_of(trial, video));
  }
  if (inputs.empty()) return found;
  auto made = detect(session, trial, inputs, wanted, console);
  if (!made) return made.error();
  for (CameraDetections& camera : *made) {
    if (!camera.broken_off) {
      const Status written = caches.at(camera.camera).write(camera);
      if (!written) return written.error();
    }
    found[index(camera.camera)] = std::move(camera);
  }
  return found;
}

}  // namespace

Result<std::vector<CameraDetections>> find_tags(const recordings::Session& session,
                                                const Trial& trial,
                                                const std::filesystem::path& out,
                                                Console& console,
                                                std::vector<Finding>& findings) {
  const ContentToDetect wanted = content_to_detect(session, trial);
  auto read = read_or_detect(session, trial, wanted, out, console, findings);
  if (!read) return read.error();
  std::vector<CameraDetections>& found = *read;
  if (const Status ok = check_readable(trial, found, findings); !ok) return ok.error();
  for (const TrialVideo& video : trial.videos) {
    CameraDetections& camera = found[index(video.camera)];
    if (camera.frames.empty()) continue;
    camera.camera = video.camera;
    camera.source = video.path.string();
    camera.offset = video.offset;
    if (trial.rate) camera.rate = *trial.rate;
  }
  const Status seen = check_content(session, trial, found, wanted, findings);
  if (!seen) return seen.error();
  assess_video_lengths(session, trial, found, findings);
  if (const Status ok = match_times(trial, found, findings); !ok) return ok.error();
  if (const Status ok = check_rates(session, trial, found); !ok) return ok.error();
  return read;
}

void correct_shrinkage(std::span<const Camera> cameras,
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

}  // namespace marey::app
