// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The line's second stage: from what was seen of a board, or a wand, to cameras.
#include <algorithm>
#include <utility>

#include "app/calibrate_session.h"
#include "app/calibration_report.h"
#include "app/judge_calibration.h"
#include "app/pipeline.h"
#include "app/stopwatch.h"
#include "app/version.h"
#include "core/assert.h"
#include "recordings/atomic_file.h"
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
  auto rig = calibrate_session(session_, *waved, floor);
  if (!rig) return in_session(rig.error());
  progress(1, 1);
  recordings::Calibration calibration{rig->cameras, rig->quality, {}, rig->rms_px};
  calibration.clocks.resize(rig->cameras.size());
  time_stage("cameras", watch.seconds());
  const Status written =
      recordings::write_calibration(options_.out / "calibration.toml", calibration);
  if (!written) return written;
  const Status shown = show_cameras(std::move(*rig), waved->front().rate.hz);
  return shown ? need_cameras() : shown;
}

Status Pipeline::show_cameras(calib::CalibratedRig rig, double rate_hz) {
  const CalibrationReport report = report_calibration(
      {session_.name, kVersion, &session_.target, session_.subject.stature_m, rate_hz},
      std::move(rig));
  for (Error& poor : poor_of(report)) {
    report_.warnings.push_back(poor.message());
    failures_.push_back(std::move(poor));
  }
  for (std::string& warning : warnings_of(report)) {
    report_.warnings.push_back(std::move(warning));
  }
  report_.cameras_are_judged = true;
  const Status written =
      recordings::write_file(options_.out / "calibration.json", calibration_json(report));
  if (!written) return written;
  return recordings::write_file(options_.out / "calibration.html",
                                calibration_html(report));
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
