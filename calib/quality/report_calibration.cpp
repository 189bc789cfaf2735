// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/quality/report_calibration.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "calib/plan/body_heights.h"
#include "calib/quality/assess_calibration.h"
#include "calib/quality/map_errors.h"
#include "calib/quality/measure_calibration.h"
#include "core/base/assert.h"

namespace marey::calib {

CalibrationReport report_calibration(const CalibrationSource& source, CalibratedRig rig) {
  MAREY_ASSERT(source.target && !rig.cameras.empty());
  CalibrationReport report;
  report.session = source.session;
  report.version = source.version;
  report.target = name_of(*source.target);
  const bool is_wand = std::holds_alternative<Wand>(*source.target);
  if (!is_wand) report.extent = extent_of(*source.target);
  report.stature_m = source.stature_m > 0.0 ? source.stature_m : kTypicalStature_m;
  report.rate_hz = source.rate_hz;
  report.rig = std::move(rig);
  const auto& views = report.rig.views;
  report.board_on_floor =
      !is_wand && std::any_of(views.begin(), views.end(), [](const auto& view) {
        return view.frame == kFloorInstant;
      });
  report.has_floor = source.has_floor || report.board_on_floor;
  const auto& clocks = report.rig.clocks;
  report.has_clocks = std::any_of(clocks.begin(), clocks.end(), [](const auto& clock) {
    return clock.offset_sigma_s > 0.0 || clock.drift_sigma > 0.0 ||
           clock.line_delay_sigma_s > 0.0;
  });
  // Points have the same accuracy as corners: the RMS error of the calibration. A
  // hundredth of a pixel for exact corners.
  report.corner_sigma_px = std::max(report.rig.inlier_rms_px / std::numbers::sqrt2, 0.01);
  report.cameras = measure_cameras(report);
  report.map = map_errors(report);
  report.findings = assess_calibration(report);
  return report;
}

}  // namespace marey::calib
