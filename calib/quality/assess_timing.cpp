// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/quality/assess_timing.h"

#include <algorithm>
#include <cmath>

#include "calib/quality/assess_camera_faults.h"
#include "calib/quality/calibration_limits.h"

namespace marey::calib {
namespace {

// Webcam quartzes are accurate to about fifty parts in a million, their time stamps to
// two hundred.
constexpr double kFairDrift = 3e-4;
constexpr double kPoorDrift = 1e-3;
constexpr double kSignificant = 3.0;
// Rolling shutters of webcams take 10 to 35 ms from the first row to the last, also at
// lower frame rates.
constexpr double kMaxReadout_s = 0.07;

/// A sensor finishes its last row before its next image begins.
void assess_line_delay(FindingCollector& list, std::size_t c) {
  const SolvedClock& clock = list.report.rig.clocks[c];
  const double sigma_s = clock.line_delay_sigma_s;
  if (!(sigma_s > 0.0) || !(list.report.rate_hz > 0.0)) return;
  const double rows = list.report.rig.cameras[c].intrinsics.height_px;
  const double max_s = std::min(kMaxReadout_s, 1.0 / list.report.rate_hz);
  const double delay_s = std::abs(clock.line_delay_s);
  const auto& clocks = list.report.rig.clocks;
  const bool has_offsets = std::any_of(
      clocks.begin(), clocks.end(), [](const auto& k) { return k.offset_sigma_s > 0.0; });
  const char* next =
      has_offsets
          ? "leave out line_delays of [calibration] in session.toml, or show more fast "
            "movements in all parts of the picture"
          : "set clocks = \"offsets\" under [calibration] in session.toml, or leave out "
            "line_delays: a clock offset looks like a line delay";
  if ((delay_s - kSignificant * sigma_s) * rows > max_s) {
    list.add(Severity::kPoor,
             "line-delay",
             list.camera(c),
             format_text(
                 "its line delay is %.0f us, which is %.0f ms for a picture (cameras: "
                 "under %.0f)",
                 1e6 * clock.line_delay_s,
                 1e3 * rows * delay_s,
                 1e3 * max_s),
             next)
        .measured(1e3 * rows * delay_s, 1e3 * max_s, "ms");
  } else if (clock.line_delay_s < -kSignificant * sigma_s && rows * delay_s > 1e-3) {
    list.add(
        Severity::kFair,
        "line-delay",
        list.camera(c),
        format_text("its rows seem to be read from the bottom up (%.0f us each), which "
                    "is possible only if the picture was turned upside down",
                    1e6 * clock.line_delay_s),
        next);
  }
}

void assess_drift(FindingCollector& list, std::size_t c) {
  const SolvedClock& clock = list.report.rig.clocks[c];
  if (!(clock.drift_sigma > 0.0)) return;
  const double significant_drift =
      std::abs(clock.drift) - kSignificant * clock.drift_sigma;
  if (significant_drift <= kFairDrift) return;
  list.add(severity_of(significant_drift, kPoorDrift),
           "drift",
           list.camera(c),
           format_text("its clock drifts by %.0f ppm (cameras: under 200): the rate "
                       "stated in its video is wrong, or it skips frames",
                       1e6 * clock.drift),
           "record at a rate that the camera keeps, with fixed exposure, and check the "
           "video's frame times");
}

void assess_slip(FindingCollector& list, std::size_t c) {
  const auto& slip = list.report.cameras[c].slip;
  const double scale = pixel_scale(list.report.rig.cameras[c]);
  if (!slip || slip->moved_px < 0.3 * scale || seems_moved(list.report, c)) return;
  list.add(severity_of(slip->moved_px, scale),
           "slip",
           list.camera(c),
           format_text(
               "from frame %d on it is %.1f frames %s than before, compared with the "
               "others (%.1f px of the %s's movement): %s",
               slip->from_frame,
               std::abs(slip->frames),
               slip->frames > 0.0 ? "later" : "earlier",
               slip->moved_px,
               list.target(),
               slip->frames > 0.0 ? "its video skips frames"
                                  : "another camera's video skips frames, or its own "
                                    "repeats some"),
           "record the calibration again, at a rate that the camera and the computer "
           "keep")
      .measured(slip->moved_px, std::nullopt, "px");
}

}  // namespace

void assess_timing(FindingCollector& list) {
  for (std::size_t c = 0; c < list.report.cameras.size(); ++c) {
    if (c < list.report.rig.clocks.size()) {
      assess_line_delay(list, c);
      assess_drift(list, c);
    }
    assess_slip(list, c);
  }
}

}  // namespace marey::calib
