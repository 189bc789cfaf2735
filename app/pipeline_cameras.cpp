// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The line's second stage: from what was seen of a board, or a wand, to cameras.
#include <algorithm>
#include <utility>

#include "app/calibrate_session.h"
#include "app/pipeline.h"
#include "app/stopwatch.h"
#include "core/assert.h"
#include "recordings/calibration_file.h"

namespace marey::app {

using recordings::Trial;
using recordings::TrialKind;

Status Pipeline::calibrate() {
  const Trial* waved_trial = session_.find(TrialKind::kCalibration);
  const Trial* floor_trial = session_.find(TrialKind::kFloor);
  MAREY_ASSERT(waved_trial);
  const auto waved = detections_of(*waved_trial);
  if (!waved) return waved.error();
  std::vector<CameraDetections> floor;
  if (floor_trial) {
    auto found = detections_of(*floor_trial);
    if (!found) return found.error();
    floor = std::move(*found);
  }
  for (const CameraDetections& camera : *waved) {
    if (!camera.frames.empty()) continue;
    return bad_input(
        session_.file.string(),
        "camera \"" + session_.cameras[index(camera.camera)] +
            "\" has no video in trial \"" + waved_trial->name + "\"",
        "every camera must see the calibration board: add its video, or take the camera "
        "out of the session");
  }
  const Stopwatch watch;
  const Progress progress = console_->stage("cameras");
  progress(0, 1);
  const auto rig = calibrate_session(session_, *waved, floor);
  if (!rig) return in_session(rig.error());
  progress(1, 1);
  recordings::Calibration calibration{rig->cameras, rig->quality, {}, rig->rms_px};
  calibration.clocks.resize(rig->cameras.size());
  time_stage("cameras", watch.seconds());
  const Status written =
      recordings::write_calibration(options_.out / "calibration.toml", calibration);
  return written ? need_cameras() : written;
}

Status Pipeline::need_cameras() {
  const auto file = options_.out / "calibration.toml";
  const auto calibration = recordings::read_calibration(file);
  if (!calibration) {
    Error error = calibration.error();
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) {
      error.next = "run marey calibrate on this session first, with the same --out";
    }
    return error;
  }
  report_.calibration_rms_px = calibration->rms_px;
  report_.cameras.clear();
  for (std::size_t c = 0; c < calibration->cameras.size(); ++c) {
    report_.cameras.push_back({calibration->cameras[c], calibration->quality[c]});
  }
  cameras_.clear();
  for (const std::string& name : session_.cameras) {
    const auto found = std::find_if(calibration->cameras.begin(),
                                    calibration->cameras.end(),
                                    [&](const Camera& c) { return c.name == name; });
    if (found == calibration->cameras.end()) {
      return bad_input(file.string(),
                       "camera \"" + name + "\" of the session is not in it",
                       "run marey calibrate on this session again");
    }
    cameras_.push_back(*found);
  }
  return Done{};
}

}  // namespace marey::app
