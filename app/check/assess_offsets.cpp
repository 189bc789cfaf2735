// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/check/assess_offsets.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>

#include "core/base/format_text.h"

namespace marey::app {
namespace {

using recordings::Session;
using recordings::Trial;
using recordings::TrialVideo;

// In correct sessions the estimated offsets differ from the true ones by half of this. A
// foot of 1.5 m/s travels by 6 mm in this time.
constexpr double kHarmless_s = 4e-3;
constexpr double kSigmas = 6.0;

/// Offset of a camera in the session, and its estimate from the tags.
struct GivenClock {
  std::size_t camera = 0;
  double given_s = 0.0;
  double seen_s = 0.0;  ///< Relative to the first camera.
  double limit_s = 0.0;
};

bool differs(double a_s, double b_s, double limit_s) {
  return std::abs(a_s - b_s) > limit_s;
}

/// Returns the offsets that can be compared with tags, without the first camera.
std::vector<GivenClock> given_clocks(const Trial& trial,
                                     std::span<const calib::ClockOffset> seen) {
  std::vector<GivenClock> clocks;
  for (const TrialVideo& video : trial.videos) {
    const std::size_t c = index(video.camera);
    constexpr double kKnown_s = 0.01;
    if (c == 0 || !video.offset || seen[c].sigma_s > kKnown_s) continue;
    clocks.push_back({c,
                      seconds(*video.offset),
                      seen[c].offset_s,
                      std::max(kHarmless_s, kSigmas * seen[c].sigma_s)});
  }
  return clocks;
}

double first_offset_s(const Trial& trial) {
  for (const TrialVideo& video : trial.videos) {
    if (index(video.camera) == 0) return seconds(video.offset.value_or(Timestamp{0}));
  }
  return 0.0;
}

/// Returns the offsets that fit, as "{ cam1 = 0.0073, cam2 = -0.0111 }".
std::string fitting(const Session& session, const std::vector<GivenClock>& clocks) {
  std::string text = "{";
  for (const GivenClock& clock : clocks) {
    text += (text.size() > 1 ? ", " : " ") + session.cameras[clock.camera] +
            format_text(" = %.4f", clock.seen_s);
  }
  return text + " }";
}

}  // namespace

std::optional<Finding> assess_offsets(const Session& session,
                                      const Trial& trial,
                                      std::span<const calib::ClockOffset> seen) {
  const std::vector<GivenClock> clocks = given_clocks(trial, seen);
  const double first_s = first_offset_s(trial);
  std::vector<const GivenClock*> wrong;
  for (const GivenClock& clock : clocks) {
    if (differs(clock.given_s - first_s, clock.seen_s, clock.limit_s)) {
      wrong.push_back(&clock);
    }
  }
  if (wrong.empty()) return std::nullopt;
  const bool is_other_sign =
      std::none_of(clocks.begin(), clocks.end(), [&](const GivenClock& clock) {
        return differs(first_s - clock.given_s, clock.seen_s, clock.limit_s);
      });
  // If all offsets are wrong by the same amount, only that of the first camera is wrong.
  const double first_by_s = wrong.front()->given_s - first_s - wrong.front()->seen_s;
  const bool is_first =
      first_s != 0.0 && clocks.size() > 1 && wrong.size() == clocks.size() &&
      std::all_of(wrong.begin(), wrong.end(), [&](const GivenClock* clock) {
        return !differs(
            clock->given_s - first_s - clock->seen_s, first_by_s, clock->limit_s);
      });
  std::string cause;
  for (const GivenClock* clock : wrong) {
    cause += (cause.empty() ? "camera " : ", camera ") + session.cameras[clock->camera] +
             format_text(" is %.1f ms after %s by time_offset_s, and %.1f ms by its tags",
                         1e3 * (clock->given_s - first_s),
                         session.cameras.front().c_str(),
                         1e3 * clock->seen_s);
  }
  if (is_other_sign) {
    cause += ": with the other sign they would agree";
  } else if (is_first) {
    cause += ": all by the same amount, so the offset of " + session.cameras.front() +
             " is wrong";
  }
  return poor_finding(
      "offset",
      session.file.string() + ":" + std::to_string(trial.line) + ": trial " + trial.name,
      cause,
      "correct time_offset_s of that trial (" + fitting(session, clocks) +
          " would fit), or leave it out: offsets are then found");
}

std::optional<Finding> assess_trial_offsets(const Session& session,
                                            const Trial& trial,
                                            std::span<const Camera> cameras,
                                            std::span<const CameraDetections> detections,
                                            double centre_sigma_m) {
  const bool any = std::any_of(trial.videos.begin(),
                               trial.videos.end(),
                               [](const TrialVideo& v) { return v.offset.has_value(); });
  if (!any) return std::nullopt;
  std::map<TagId, double> sizes_m;
  for (const TagOnSegment& tag : session.tags) sizes_m[tag.id] = tag.size_m;
  auto seen = calib::find_clock_offsets(cameras, detections, sizes_m);
  // A wrong camera position has the effect of a delay: the position error divided by the
  // speed of the tags. The limit is twice the speed of a walker (1.5 m/s), as six sigmas
  // are allowed.
  constexpr double kSpeed_m_s = 3.0;
  for (calib::ClockOffset& clock : seen) {
    clock.sigma_s = std::hypot(clock.sigma_s, centre_sigma_m / kSpeed_m_s);
  }
  // Offsets from a table of times are not part of the session.
  for (const TrialVideo& video : trial.videos) {
    const auto& whole = detections[index(video.camera)].offset;
    if (!whole) continue;
    seen[index(video.camera)].offset_s -=
        seconds(*whole - video.offset.value_or(Timestamp{0}));
  }
  return assess_offsets(session, trial, seen);
}

}  // namespace marey::app
