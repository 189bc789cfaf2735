// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/check/assess_trial.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "core/base/format_text.h"
#include "core/base/quantile.h"

namespace marey::app {
namespace {

using reconstruct::CameraResidual;
using reconstruct::ResidualSize;
using reconstruct::StretchResidual;
using reconstruct::TagResidual;
using reconstruct::TrialResiduals;

// Correct trials of both rendered recordings: a delay explains 2 % of the errors and is
// at most 0.2 ms. Offsets that are wrong by 5 to 11 ms: 25 to 40 %, and 2 to 3 ms.
constexpr double kClockShare = 0.12;
constexpr double kClock_s = 1e-3;

/// Limits of residuals at the body. [m] Tags on soft skin slip by 7 mm, all of them, so a
/// residual below `any_m` is an error only if the others are far smaller.
struct Limits {
  double any_m = 0.0;
  double min_m = 0.0;
  double times_others = 0.0;

  [[nodiscard]] bool is_beyond(double here_m, double others_m) const {
    return here_m > any_m || (here_m > min_m && here_m > times_others * others_m);
  }
};
constexpr Limits kCamera{20e-3, 5e-3, 4.0};    // Root mean square.
constexpr Limits kTag{15e-3, 5e-3, 6.0};       // Median.
constexpr Limits kStretch{30e-3, 10e-3, 5.0};  // Root mean square.
constexpr int kMinCorners = 80;                // 20 pictures.

std::string in_mm(double m) {
  return format_text("%.1f mm", 1e3 * m);
}

/// Returns the item with the largest value, and the median of all values; nullopt if no
/// item has enough corners.
template <class Item, class Value>
std::optional<std::pair<const Item*, double>> worst_of(const std::vector<Item>& items,
                                                       const Value& value) {
  const Item* worst = nullptr;
  std::vector<double> all;
  for (const Item& item : items) {
    if (item.size.corners < kMinCorners) continue;
    all.push_back(value(item));
    if (!worst || value(item) > value(*worst)) worst = &item;
  }
  if (!worst) return std::nullopt;
  return std::pair(worst, median(std::move(all)));
}

std::optional<Finding> assess_clock(const recordings::Session& session,
                                    const recordings::Trial& trial,
                                    const TrialResiduals& residuals) {
  std::string cause;
  for (std::size_t c = 0; c < residuals.cameras.size(); ++c) {
    const CameraResidual& camera = residuals.cameras[c];
    if (camera.size.corners < kMinCorners || camera.explained < kClockShare ||
        std::abs(camera.late_s) < kClock_s) {
      continue;
    }
    cause += (cause.empty() ? "" : ", ") + session.cameras[c] +
             format_text(" by %.0f ms or more %s",
                         1e3 * std::abs(camera.late_s),
                         camera.late_s > 0.0 ? "late" : "early");
  }
  if (cause.empty()) return std::nullopt;
  const bool is_given =
      std::any_of(trial.videos.begin(), trial.videos.end(), [](const auto& video) {
        return video.offset.has_value();
      });
  return poor_finding(
      "clock",
      "trial " + trial.name,
      "clocks of cameras do not fit the movement: " + cause,
      is_given ? "correct time_offset_s of that trial in session.toml, or leave "
                 "it out: offsets are then found"
               : "check that these videos skip no frames and run at one rate, "
                 "and that no camera has a rolling shutter; give the trial "
                 "`timestamps` if frames were dropped");
}

std::optional<Finding> assess_camera(const recordings::Session& session,
                                     const recordings::Trial& trial,
                                     const TrialResiduals& residuals) {
  const auto worst =
      worst_of(residuals.cameras, [](const CameraResidual& c) { return c.size.rms_m; });
  if (!worst || !kCamera.is_beyond(worst->first->size.rms_m, worst->second)) {
    return std::nullopt;
  }
  const auto c = static_cast<std::size_t>(worst->first - residuals.cameras.data());
  return poor_finding(
      "camera",
      "trial " + trial.name + ", camera " + session.cameras[c],
      "its reprojection error at the body is " + in_mm(worst->first->size.rms_m) +
          " RMS (the cameras' median is " + in_mm(worst->second) + ")",
      "check that this is its video of this trial, that it was not moved or "
      "refocused since the calibration, and that its video skips no frames");
}

std::optional<Finding> assess_tag(const recordings::Trial& trial,
                                  const TrialResiduals& residuals) {
  const auto worst =
      worst_of(residuals.tags, [](const TagResidual& t) { return t.size.median_m; });
  if (!worst || !kTag.is_beyond(worst->first->size.median_m, worst->second)) {
    return std::nullopt;
  }
  return poor_finding(
      "tag",
      "trial " + trial.name + ", tag " + std::to_string(number(worst->first->id)),
      "it is seen " + in_mm(worst->first->size.median_m) + " from its place on segment " +
          std::string(name(worst->first->segment)) + " (median; that of all tags is " +
          in_mm(worst->second) + ")",
      "check that it did not shift after the range of motion, and that it is worn on "
      "that segment; then record again, or remove it from session.toml");
}

std::optional<Finding> assess_stretch(const recordings::Trial& trial,
                                      const TrialResiduals& residuals) {
  const auto worst = worst_of(residuals.stretches,
                              [](const StretchResidual& s) { return s.size.rms_m; });
  if (!worst || !kStretch.is_beyond(worst->first->size.rms_m, worst->second)) {
    return std::nullopt;
  }
  return poor_finding(
      "stretch",
      "trial " + trial.name,
      format_text(
          "in frames %d to %d", worst->first->first_frame, worst->first->last_frame) +
          " the reprojection error at the body is " + in_mm(worst->first->size.rms_m) +
          " RMS (median of half seconds " + in_mm(worst->second) + ")",
      "look at these frames in report.html: another person in view, tags that "
      "were read wrongly, or a camera that was pushed; leave them out with "
      "`frames`");
}

}  // namespace

std::optional<Finding> assess_trial(const recordings::Session& session,
                                    const recordings::Trial& trial,
                                    const TrialResiduals& residuals) {
  if (auto found = assess_clock(session, trial, residuals)) return found;
  if (auto found = assess_camera(session, trial, residuals)) return found;
  if (auto found = assess_tag(trial, residuals)) return found;
  return assess_stretch(trial, residuals);
}

}  // namespace marey::app
