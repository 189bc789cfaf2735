// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Second stage of the pipeline: calibrates the cameras from detections of a board or a
// wand.
#include <algorithm>
#include <utility>

#include "app/check/check_trial_kinds.h"
#include "app/pages/calibration_html.h"
#include "app/pages/calibration_json.h"
#include "app/process/calibrate_session.h"
#include "app/process/find_tags.h"
#include "app/process/pipeline.h"
#include "app/process/stand_on_floor.h"
#include "app/shell/version.h"
#include "calib/quality/assess_calibration.h"
#include "calib/quality/calibration_report.h"
#include "calib/quality/report_calibration.h"
#include "core/base/assert.h"
#include "core/base/stopwatch.h"
#include "reconstruct/clusters/check_views.h"
#include "recordings/base/atomic_file.h"
#include "recordings/session/calibration_file.h"

namespace marey::app {

using recordings::Trial;
using recordings::TrialKind;

Result<CalibrationSights> Pipeline::calibration_sights() {
  CalibrationSights sights;
  for (const auto& [kind, place] : {std::pair(TrialKind::kCalibration, &sights.waved),
                                    std::pair(TrialKind::kFloor, &sights.floor),
                                    std::pair(TrialKind::kStatic, &sights.standing)}) {
    const Trial* trial = session_.find(kind);
    if (!trial) continue;
    auto found = detections_of(*trial);
    if (!found) return found.error();
    *place = std::move(*found);
  }
  const Trial* waved = session_.find(TrialKind::kCalibration);
  MAREY_ASSERT(waved);
  for (const CameraDetections& camera : sights.waved) {
    if (!camera.frames.empty()) continue;
    return bad_input(
        session_.file.string(),
        "camera \"" + session_.cameras[index(camera.camera)] +
            "\" has no video in trial \"" + waved->name + "\"",
        "every camera must see the calibration target: add its video, or remove the "
        "camera from the session");
  }
  return sights;
}

/// Checks that the subject of the static trial has the declared stature and stands
/// upright. A wrongly measured board fails here, before the calibration is written.
Status Pipeline::check_subject(const SessionRig& found,
                               std::vector<CameraDetections> standing) const {
  if (standing.empty() || session_.tags.empty()) return Done{};
  const auto& cameras = found.rig.cameras;
  correct_shrinkage(cameras, standing);
  const Status ok = reconstruct::check_views(cameras, standing, session_.tags);
  return ok ? check_upright(session_, cameras, standing) : ok;
}

Status Pipeline::calibrate() {
  auto sights = calibration_sights();
  if (!sights) return sights.error();
  // This check comes first, because a walking subject resembles a tilted floor.
  if (const Status ok = check_standing(session_, detections_); !ok) return ok;
  const Stopwatch watch;
  const Progress progress = console_->stage("cameras");
  auto found = calibrate_session(session_, *sights, progress);
  if (!found) return in_session(found.error());
  const calib::CalibratedRig& rig = found->rig;
  if (const Status ok = check_subject(*found, std::move(sights->standing)); !ok) {
    return in_session(ok.error());
  }
  for (const std::string& note : found->notes) console_->say(note);
  recordings::Calibration calibration{rig.cameras, rig.quality, {}, rig.rms_px};
  for (const calib::SolvedClock& clock : rig.clocks) {
    calibration.clocks.push_back({clock.offset_s, 1e6 * clock.drift, clock.line_delay_s});
  }
  time_stage("cameras", watch.seconds());
  const Status written =
      recordings::write_calibration(options_.out / "calibration.toml", calibration);
  if (!written) return written;
  const Status shown = show_cameras(std::move(*found), sights->waved.front().rate.hz);
  return shown ? need_cameras() : shown;
}

Status Pipeline::show_cameras(SessionRig found, double rate_hz) {
  const calib::CalibrationReport report =
      calib::report_calibration({session_.name,
                                 kVersion,
                                 &session_.target,
                                 session_.subject.stature_m,
                                 rate_hz,
                                 found.has_floor},
                                std::move(found.rig));
  for (Finding finding : report.findings) {
    if (finding.severity == Severity::kNote) continue;
    finding.where = "calibration, " + finding.where;
    add(std::move(finding));
  }
  report_.cameras_are_assessed = true;
  const Status written = recordings::write_file(options_.out / "calibration.json",
                                                calibration_json_text(report));
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
                       "it does not contain camera \"" + name + "\" of the session",
                       "run marey calibrate on this session again");
    }
    cameras_.push_back(*found);
  }
  return Done{};
}

}  // namespace marey::app
