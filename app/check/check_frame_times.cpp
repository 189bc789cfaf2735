// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/check/check_frame_times.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/format_text.h"
#include "recordings/takes/video_times.h"

namespace marey::app {

using recordings::Trial;
using recordings::TrialVideo;

namespace {

/// Returns the largest distance of a frame from an even rate. [s]
double max_offset_s(const std::vector<Timestamp>& times, double hz, double first_s) {
  double worst_s = 0.0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double even_s = first_s + static_cast<double>(i) / hz;
    worst_s = std::max(worst_s, std::abs(seconds(times[i] - times.front()) - even_s));
  }
  return worst_s;
}

/// Returns the rate of times that are even within the precision of a container; else
/// nullopt.
std::optional<FrameRate> even_rate(const std::vector<Timestamp>& times) {
  constexpr double kEven = 0.25;
  if (times.size() < 3) return std::nullopt;
  const double length_s = seconds(times.back() - times.front());
  const double hz = static_cast<double>(times.size() - 1) / length_s;
  if (!(length_s > 0.0) || max_offset_s(times, hz, 0.0) * hz > kEven) return std::nullopt;
  return FrameRate{hz};
}

/// Checks the rates that videos state against "fps" and "slow_motion". Errors: rates that
/// differ between videos; declared slow motion that contradicts them.
Status check_slow_motion(const Trial& trial,
                         const std::vector<std::pair<std::string, FrameRate>>& others,
                         const std::string& steady) {
  // Cameras of 120 Hz write 29.97 Hz as well as 30.
  constexpr double kSameRate = 0.01;
  const std::string declared =
      format_text("fps = %.2f and slow_motion = %.4g of trial %s",
                  trial.rate->hz,
                  trial.slow_motion,
                  trial.name.c_str());
  const double expected_hz = trial.rate->hz / trial.slow_motion;
  const char* next =
      "correct both in session.toml: fps is the rate at which pictures were taken, "
      "slow_motion how many times slower the video plays; remove slow_motion if the "
      "video plays at normal speed";
  if (!steady.empty() || others.empty()) {
    const std::string expected =
        format_text(" mean videos that play at %.2f frames per second", expected_hz);
    return bad_input(
        steady.empty() ? "trial " + trial.name : steady,
        declared + expected +
            (steady.empty() ? ", but none of them states an even rate"
                            : format_text(", but it plays at %.2f", trial.rate->hz)),
        next);
  }
  for (const auto& [source, rate] : others) {
    if (std::abs(rate.hz / expected_hz - 1.0) < kSameRate) continue;
    return bad_input(
        source,
        declared +
            format_text(" mean a video that plays at %.2f frames per second, but its own "
                        "times give %.2f",
                        expected_hz,
                        rate.hz),
        next);
  }
  return Done{};
}

/// Checks videos with another constant rate than `fps` of the trial. If all have the same
/// rate, either they are slow motion or `fps` is wrong, so this is a failure that the
/// user resolves. If only some differ, they belong to another recording or were
/// converted: an error.
Status check_stated(const Trial& trial,
                    const std::vector<std::pair<std::string, FrameRate>>& others,
                    const std::string& steady,
                    std::vector<Finding>& findings) {
  if (others.empty()) return Done{};
  const auto& [source, rate] = others.front();
  const auto is_alike = [&](const auto& other) {
    return std::abs(other.second.hz / rate.hz - 1.0) < 1e-3;
  };
  const std::string own =
      format_text("its own times give a steady %.2f frames per second", rate.hz);
  const std::string declared =
      format_text("fps of trial %s is %.2f", trial.name.c_str(), trial.rate->hz);
  if (!steady.empty() || !std::all_of(others.begin(), others.end(), is_alike)) {
    return bad_input(source,
                     own + ", and " + declared +
                         (steady.empty() ? std::string(", a rate that no other video has")
                                         : ", at which " + steady + " runs"),
                     "record all cameras at one rate; if this file states its rate "
                     "wrongly, correct the file");
  }
  findings.push_back(poor_finding(
      "rate",
      source,
      own + " (as for the other videos), and " + declared +
          format_text(": movements are computed %.2f times as fast as in the video",
                      trial.rate->hz / rate.hz),
      format_text(
          "correct fps in session.toml, or leave it out; if the videos play in slow "
          "motion, add slow_motion = %.3g to the trial",
          trial.rate->hz / rate.hz)));
  return Done{};
}

}  // namespace

std::optional<UnevenVideo> find_uneven_video(const TrialVideo& video, FrameRate rate) {
  std::error_code ignored;
  if (std::filesystem::is_directory(video.path, ignored)) return std::nullopt;
  auto times = recordings::video_times(video.path);
  if (!times || !capture::measured_rate(*times)) return std::nullopt;
  // Rounding of a container stays below this limit; larger deviations come from the
  // camera.
  constexpr double kSteady = 0.25;
  const double worst_s = max_offset_s(*times, rate.hz, 0.0);
  if (worst_s * rate.hz < kSteady) return std::nullopt;
  auto other = even_rate(*times);
  constexpr double kSameRate = 2e-3;
  if (other && std::abs(other->hz / rate.hz - 1.0) < kSameRate) other.reset();
  return UnevenVideo{{video.camera, std::move(*times)}, worst_s, other};
}

std::string describe_uneven_video(const UnevenVideo& video, FrameRate rate) {
  return format_text(
      "its frame rate varies: frames are up to %.1f ms away from a steady %.2f "
      "Hz",
      1e3 * video.worst_s,
      rate.hz);
}

Status check_frame_times(const Trial& trial,
                         std::span<const CameraDetections> found,
                         std::vector<Finding>& findings) {
  std::vector<std::pair<std::string, FrameRate>> others;  // Sources of another rate.
  std::string steady;  // A source of the trial's own rate.
  for (const TrialVideo& video : trial.videos) {
    const CameraDetections& camera = found[index(video.camera)];
    std::error_code ignored;
    // A folder of images has no times of its own.
    if (camera.frames.empty() || std::filesystem::is_directory(video.path, ignored)) {
      continue;
    }
    const FrameRate rate = trial.rate.value_or(camera.rate);
    const auto uneven = find_uneven_video(video, rate);
    if (!uneven) {
      steady = camera.source;
      continue;
    }
    if (trial.rate && uneven->other_rate) {
      others.emplace_back(camera.source, *uneven->other_rate);
      continue;
    }
    if (!trial.rate) {
      return bad_input(camera.source,
                       describe_uneven_video(*uneven, rate) +
                           ", so frame numbers do not determine the times",
                       "remove \"frames\" from trial " + trial.name +
                           ", so that the times of the video are used; or give the trial "
                           "an \"fps\", if frames with equal numbers belong together");
    }
    findings.push_back(fair_finding(
        "uneven",
        camera.source,
        describe_uneven_video(*uneven, rate) + "; the session's fps is still used"));
  }
  return trial.slow_motion != 1.0 ? check_slow_motion(trial, others, steady)
                                  : check_stated(trial, others, steady, findings);
}

}  // namespace marey::app
