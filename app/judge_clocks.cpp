// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/judge_clocks.h"

#include <algorithm>
#include <cmath>

#include "app/calibration_limits.h"
#include "app/judge_faults.h"

namespace marey::app {
namespace {

// Quartz of webcams is good to some fifty parts in a million, the times they set on
// frames to two hundred.
constexpr double kFairDrift = 3e-4;
constexpr double kPoorDrift = 1e-3;
constexpr double kSurely = 3.0;
// Rolling shutters of webcams take 10 to 35 ms from the first row to the last, also when
// pictures come more slowly.
constexpr double kLongestPicture_s = 0.07;

/// A sensor has read its last row when its next picture begins.
void judge_line_delay(FindingList& list, std::size_t c) {
  const calib::SolvedClock& clock = list.report.rig.clocks[c];
  const double sigma_s = clock.line_delay_sigma_s;
  if (!(sigma_s > 0.0) || !(list.report.rate_hz > 0.0)) return;
  const double rows = list.report.rig.cameras[c].intrinsics.height_px;
  const double longest_s = std::min(kLongestPicture_s, 1.0 / list.report.rate_hz);
  const double delay_s = std::abs(clock.line_delay_s);
  const auto& clocks = list.report.rig.clocks;
  const bool has_offsets = std::any_of(
      clocks.begin(), clocks.end(), [](const auto& k) { return k.offset_sigma_s > 0.0; });
  const char* next =
      has_offsets
          ? "leave out line_delays of [calibration] in session.toml, or show more fast "
            "movements in all parts of the picture"
          : "set clocks = \"offsets\" under [calibration] in session.toml, or leave out "
            "line_delays: what a clock is off hides in it";
  if ((delay_s - kSurely * sigma_s) * rows > longest_s) {
    list.add(Severity::kPoor,
             "line-delay",
             list.camera(c),
             worded("its rows would follow each other by %.0f us, which is %.0f ms for a "
                    "picture (cameras: under %.0f)",
                    1e6 * clock.line_delay_s,
                    1e3 * rows * delay_s,
                    1e3 * longest_s),
             next);
  } else if (clock.line_delay_s < -kSurely * sigma_s && rows * delay_s > 1e-3) {
    list.add(Severity::kFair,
             "line-delay",
             list.camera(c),
             worded("its rows would be read from the bottom up (%.0f us each), as they "
                    "are only of a picture that was turned upside down",
                    1e6 * clock.line_delay_s),
             next);
  }
}

void judge_drift(FindingList& list, std::size_t c) {
  const calib::SolvedClock& clock = list.report.rig.clocks[c];
  if (!(clock.drift_sigma > 0.0)) return;
  const double surely = std::abs(clock.drift) - kSurely * clock.drift_sigma;
  if (surely <= kFairDrift) return;
  list.add(graver(surely, kPoorDrift),
           "drift",
           list.camera(c),
           worded("its clock drifts by %.0f ppm (cameras: under 200): its video has "
                  "another rate than it says, or skips frames",
                  1e6 * clock.drift),
           "record at a rate that the camera keeps, with fixed exposure, and check the "
           "video's frame times");
}

void judge_slip(FindingList& list, std::size_t c) {
  const auto& slip = list.report.cameras[c].slip;
  const double scale = pixel_scale(list.report.rig.cameras[c]);
  if (!slip || slip->moved_px < 0.3 * scale || seems_moved(list.report, c)) return;
  list.add(graver(slip->moved_px, scale),
           "slip",
           list.camera(c),
           worded("from frame %d on it is %.1f frames %s than before against the others "
                  "(%.1f px of the %s's movement): %s",
                  slip->from_frame,
                  std::abs(slip->frames),
                  slip->frames > 0.0 ? "later" : "earlier",
                  slip->moved_px,
                  list.target(),
                  slip->frames > 0.0 ? "its video skips frames"
                                     : "another camera's video skips frames, or its own "
                                       "has some twice"),
           "record the calibration again, at a rate that the camera and the computer "
           "keep");
}

}  // namespace

void judge_clocks(FindingList& list) {
  for (std::size_t c = 0; c < list.report.cameras.size(); ++c) {
    if (c < list.report.rig.clocks.size()) {
      judge_line_delay(list, c);
      judge_drift(list, c);
    }
    judge_slip(list, c);
  }
}

}  // namespace marey::app
