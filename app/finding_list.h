// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "app/calibration_report.h"

namespace marey::app {

/// A finding that several cameras may share.
struct SharedFinding {
  Finding finding;     ///< As it is told of one camera.
  std::string figure;  ///< What differs between them: "19 %". Empty: never shared.
  std::string cause;   ///< As it is told of several.
};

/// Findings while they are gathered, with words for their figures.
struct FindingList {
  const CalibrationReport& report;
  std::vector<SharedFinding> found;

  void add(Severity severity,
           const char* kind,
           std::string where,
           std::string cause,
           std::string next) {
    found.push_back(
        {{severity, kind, std::move(where), std::move(cause), std::move(next)}, "", ""});
  }
  /// Likewise, of a camera that need not be the only one: `cause_of_many` follows their
  /// names and figures.
  void add_shared(Severity severity,
                  const char* kind,
                  std::size_t c,
                  std::string cause,
                  std::string next,
                  std::string figure,
                  std::string cause_of_many) {
    add(severity, kind, camera(c), std::move(cause), std::move(next));
    found.back().figure = report.rig.cameras[c].name + " (" + figure + ")";
    found.back().cause = std::move(cause_of_many);
  }

  [[nodiscard]] std::string camera(std::size_t c) const {
    return "camera " + report.rig.cameras[c].name;
  }
  [[nodiscard]] std::string both(std::size_t a, std::size_t b) const {
    return "cameras " + report.rig.cameras[a].name + " and " + report.rig.cameras[b].name;
  }
  [[nodiscard]] const char* target() const { return report.extent ? "board" : "wand"; }
};

/// printf() of numbers.
template <class... Numbers>
[[nodiscard]] std::string worded(const char* format, Numbers... numbers) {
  std::array<char, 400> text{};
  std::snprintf(text.data(), text.size(), format, numbers...);
  return text.data();
}

/// What figures are measured against. The first of a pair is the end of good, the second
/// of what can be used.
struct CalibrationLimits {
  std::array<double, 2> error_m;
  std::array<double, 2> residual_px;
  std::array<double, 2> coverage;
};
/// Webcams in focus end at 0.1 to 0.5 px; a pixel is blur, a bent print or clocks that
/// are a frame apart; three are another board, another video, or a camera that moved.
inline constexpr std::array<double, 2> kResidualLimitsPx{0.5, 3.0};
/// A board that was waved through all of the volume fills a third to a half of a picture.
/// Seen in less than a sixteenth of it, a lens is a guess everywhere else.
inline constexpr std::array<double, 2> kCoverageLimits{0.3, 0.0625};
[[nodiscard]] CalibrationLimits limits_of(const CalibrationReport& report);

/// The graver one when `value` goes beyond its limit.
[[nodiscard]] inline Severity graver(double value, double poor_above) {
  return value > poor_above ? Severity::kPoor : Severity::kFair;
}

/// By how much pixel limits are larger for this camera: they are for pictures up to
/// 1920 px wide, and the same lens and hand blur more pixels of a larger one.
[[nodiscard]] inline double pixel_scale(const Camera& camera) {
  const double width_px = camera.intrinsics.width_px;
  return width_px > 1920.0 ? width_px / 1920.0 : 1.0;
}

/// Whether a camera's errors clearly follow the board's movement.
[[nodiscard]] bool is_late(const CameraMeasures& camera);

/// What was shown to each camera: coverage, tilt, views, views in common.
void judge_views(FindingList& list);
/// What is left of what they saw: residuals, outliers, lags, lens, floor.
void judge_residuals(FindingList& list);
/// What follows for points: expected errors, frames and cameras held out.
void judge_trust(FindingList& list);

}  // namespace marey::app
