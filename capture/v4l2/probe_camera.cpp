// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/probe_camera.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdarg>
#include <cstdio>

#include "capture/v4l2/v4l2_kernel.h"

namespace marey::capture {
namespace {

/// Share of USB 2's 480 Mbit/s that is usable for images, for all cameras of a controller
/// together.
constexpr double kUsb2BytesPerSecond = 40e6;

[[gnu::format(printf, 1, 2)]] std::string text(const char* format, ...) {
  std::array<char, 256> out{};
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(out.data(), out.size(), format, arguments);
  va_end(arguments);
  return out.data();
}

/// Receives frames, counts them in `check`, and computes the measured rate.
void measure(V4l2Device& device,
             const ProbeCameraOptions& options,
             V4l2Kernel& kernel,
             CameraProbe& check) {
  std::optional<Timestamp> first;
  Timestamp last{0};
  Timestamp end = kernel.now() + options.patience;
  while (kernel.now() < end) {
    const auto frame = device.next(std::chrono::milliseconds(100));
    if (!frame) {
      check.trouble = frame.error();
      return;
    }
    if (!*frame) continue;
    const RawFrame& got = **frame;
    if (!first) end = kernel.now() + options.duration;
    first = first.value_or(got.time);
    last = got.time;
    ++check.frames;
    check.dropped += got.dropped_before;
    check.damaged += got.damaged ? 1 : 0;
  }
  if (!first) {
    check.trouble = Error{Errc::kDevice,
                          device.info().path,
                          "it was opened and sends no frames",
                          "unplug the camera, wait a moment and plug it in again"};
  } else if (last > *first) {
    check.measured = FrameRate{(check.frames - 1) / seconds(last - *first)};
  }
}

void advise_on_exposure(const DeviceSettings& settings,
                        std::vector<std::string>& advice) {
  const double sharp_ms = 1e3 * kSharpExposureSeconds;
  if (!settings.exposure_s) {
    advice.push_back(text(
        "it has no exposure control: only bright light keeps moving tags sharp (they "
        "need %.0f ms or less)",
        sharp_ms));
    return;
  }
  const double now_ms = 1e3 * *settings.exposure_s;
  if (settings.exposure_is_automatic) {
    advice.push_back(text(
        "its exposure is automatic, which blurs moving tags in a room's light: set it "
        "to %.0f ms or less, and add light",
        sharp_ms));
  } else if (*settings.exposure_s > kSharpExposureSeconds) {
    advice.push_back(
        text("its exposure of %.3g ms blurs a tag at 2 m and 2 m/s by "
             "%.1f px: set it to %.0f ms or less, and add light",
             now_ms,
             blur_px(*settings.exposure_s, settings.width_px),
             sharp_ms));
  }
}

void advise_on_frames(const DeviceRequest& request,
                      const CameraProbe& check,
                      std::vector<std::string>& advice) {
  const DeviceSettings& settings = *check.settings;
  if (check.measured && check.measured->hz < 0.9 * request.rate.hz) {
    advice.push_back(text(
        "it gives %.1f of %.4g frames/s: automatic exposure slows cameras down in dim "
        "light, or it does not have this rate at this size and format",
        check.measured->hz,
        request.rate.hz));
  }
  if (check.dropped > 0 || check.damaged > 0) {
    advice.push_back(text(
        "of %d frames %d were dropped and %d damaged: try another USB cable or port, "
        "not behind a hub",
        check.frames + check.dropped,
        check.dropped,
        check.damaged));
  }
  const double bytes_per_second =
      2.0 * settings.width_px * settings.height_px * settings.rate.hz;
  if (settings.format == PixelFormat::kYuyv &&
      2 * bytes_per_second > kUsb2BytesPerSecond) {
    advice.push_back(text(
        "YUYV needs %.0f MB/s: USB 2 has room for one such camera at most; MJPG needs "
        "a tenth",
        1e-6 * bytes_per_second));
  }
  if (!settings.monotonic_clock) {
    advice.push_back(
        "its driver does not guarantee the clock of its time stamps: they may not agree "
        "with those of other cameras");
  }
}

}  // namespace

std::string summary(const CameraProbe& check) {
  if (!check.settings) return check.trouble ? check.trouble->cause : "";
  const DeviceSettings& settings = *check.settings;
  std::string all = std::string(name(settings.format)) + " " +
                    text("%dx%d", settings.width_px, settings.height_px);
  if (check.trouble) return all + ": " + check.trouble->cause;
  if (check.measured) all += text(" at %.1f", check.measured->hz);
  all += settings.rate.hz > 0.0 ? text(" of %.4g frames/s", settings.rate.hz)
                                : std::string(" frames/s");
  if (settings.exposure_is_automatic) {
    all += ", exposure automatic";
  } else if (settings.exposure_s) {
    all += text(", exposure %.3g ms", 1e3 * *settings.exposure_s);
  }
  if (settings.focus) all += text(", focus %d", *settings.focus);
  if (settings.gain) all += text(", gain %d", *settings.gain);
  return all;
}

std::vector<std::string> offers(const DeviceInfo& device) {
  std::vector<std::string> lines;
  std::optional<PixelFormat> format;
  for (const DeviceMode& mode : device.modes) {
    if (mode.format != format) lines.emplace_back(name(mode.format));
    lines.back() += mode.format == format ? ", " : " ";
    format = mode.format;
    lines.back() += mode.width_px > 0 ? text("%dx%d", mode.width_px, mode.height_px)
                                      : std::string("of any size");
    std::string rates;
    for (const FrameRate& rate : mode.rates) {
      rates += (rates.empty() ? "" : ", ") + text("%.4g", rate.hz);
    }
    if (!rates.empty()) lines.back() += " (" + rates + ")";
  }
  return lines;
}

double blur_px(double exposure_s, int width_px) {
  constexpr double kMetresPerSecond = 2.0;
  constexpr double kMetresAway = 2.0;
  const double focal_px = width_px / 1.42;
  return kMetresPerSecond * exposure_s * focal_px / kMetresAway;
}

CameraProbe probe_camera(const DeviceRequest& request,
                         const ProbeCameraOptions& options,
                         V4l2Kernel& kernel) {
  CameraProbe check;
  auto device = V4l2Device::open(request, kernel);
  if (!device) {
    check.trouble = device.error();
    check.in_use = device.error().os_error == EBUSY;
    return check;
  }
  check.settings = device->settings();
  measure(*device, options, kernel, check);
  if (check.trouble) return check;
  advise_on_exposure(*check.settings, check.advice);
  advise_on_frames(request, check, check.advice);
  return check;
}

}  // namespace marey::capture
