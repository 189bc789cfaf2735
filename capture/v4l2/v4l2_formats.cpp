// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/v4l2_formats.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>

#include <linux/videodev2.h>

#include "capture/v4l2/v4l2_errors.h"

namespace marey::capture {
namespace {

struct Code {
  PixelFormat format;
  std::uint32_t fourcc;
};

/// The first code of a format is requested. Some cameras and loopbacks use the code JPEG
/// for a motion JPEG stream.
constexpr std::array kCodes{Code{PixelFormat::kMjpg, V4L2_PIX_FMT_MJPEG},
                            Code{PixelFormat::kMjpg, V4L2_PIX_FMT_JPEG},
                            Code{PixelFormat::kYuyv, V4L2_PIX_FMT_YUYV},
                            Code{PixelFormat::kNv12, V4L2_PIX_FMT_NV12},
                            Code{PixelFormat::kGrey, V4L2_PIX_FMT_GREY}};

constexpr std::array kPreference{
    PixelFormat::kMjpg, PixelFormat::kYuyv, PixelFormat::kNv12, PixelFormat::kGrey};

struct Size {
  std::uint32_t width_px;
  std::uint32_t height_px;
};

constexpr std::array<Size, 9> kTypicalSizes{{{320, 240},
                                             {640, 360},
                                             {640, 480},
                                             {800, 600},
                                             {1280, 720},
                                             {1280, 960},
                                             {1920, 1080},
                                             {2560, 1440},
                                             {3840, 2160}}};

/// Protects against a driver with endless lists.
constexpr std::uint32_t kMaxEntries = 256;

constexpr auto kCapture = static_cast<std::uint32_t>(V4L2_BUF_TYPE_VIDEO_CAPTURE);

FrameRate rate_of(const v4l2_fract& interval) {
  if (interval.numerator == 0) return FrameRate{0.0};
  return FrameRate{static_cast<double>(interval.denominator) / interval.numerator};
}

v4l2_fract interval_of(FrameRate rate) {
  const auto millihertz = static_cast<std::uint32_t>(
      std::clamp(std::lround(rate.hz * 1000.0), 1L, 1'000'000'000L));
  const std::uint32_t common = std::gcd(millihertz, 1000U);
  return {1000U / common, millihertz / common};
}

std::vector<FrameRate> list_rates(V4l2Kernel& kernel,
                                  int fd,
                                  std::uint32_t fourcc,
                                  Size size) {
  std::vector<FrameRate> rates;
  for (std::uint32_t i = 0; i < kMaxEntries; ++i) {
    v4l2_frmivalenum entry{};
    entry.index = i;
    entry.pixel_format = fourcc;
    entry.width = size.width_px;
    entry.height = size.height_px;
    if (kernel.ioctl(fd, VIDIOC_ENUM_FRAMEINTERVALS, &entry) < 0) break;
    if (entry.type != V4L2_FRMIVAL_TYPE_DISCRETE) {
      rates.push_back(rate_of(entry.stepwise.min));
      break;
    }
    rates.push_back(rate_of(entry.discrete));
  }
  std::ranges::sort(rates, std::ranges::greater{}, &FrameRate::hz);
  return rates;
}

bool within(std::uint32_t value,
            std::uint32_t min,
            std::uint32_t max,
            std::uint32_t step) {
  return value >= min && value <= max && (step == 0 || (value - min) % step == 0);
}

std::vector<Size> list_sizes(V4l2Kernel& kernel, int fd, std::uint32_t fourcc) {
  std::vector<Size> sizes;
  for (std::uint32_t i = 0; i < kMaxEntries; ++i) {
    v4l2_frmsizeenum entry{};
    entry.index = i;
    entry.pixel_format = fourcc;
    if (kernel.ioctl(fd, VIDIOC_ENUM_FRAMESIZES, &entry) < 0) break;
    if (entry.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
      sizes.push_back({entry.discrete.width, entry.discrete.height});
      continue;
    }
    const v4l2_frmsize_stepwise& range = entry.stepwise;
    for (const Size& usual : kTypicalSizes) {
      if (within(usual.width_px, range.min_width, range.max_width, range.step_width) &&
          within(
              usual.height_px, range.min_height, range.max_height, range.step_height)) {
        sizes.push_back(usual);
      }
    }
    break;
  }
  if (sizes.empty()) sizes.push_back({0, 0});
  return sizes;
}

std::string size_of(int width_px, int height_px) {
  return std::to_string(width_px) + "x" + std::to_string(height_px);
}

std::string rate_text(FrameRate rate) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g", rate.hz);
  return text.data();
}

bool has_size(const DeviceMode& mode, const DeviceRequest& request) {
  return mode.width_px == request.width_px && mode.height_px == request.height_px;
}

bool has_rate(const DeviceMode& mode, const DeviceRequest& request) {
  constexpr double kRounding = 0.99;  // 29.97 counts as 30.
  return mode.rates.empty() || mode.rates.front().hz >= kRounding * request.rate.hz;
}

/// Reads the format back; falls back to the answer of S_FMT if that is not possible.
v4l2_pix_format read_back(V4l2Kernel& kernel, int fd, const v4l2_format& answer) {
  v4l2_format now{};
  now.type = kCapture;
  return (kernel.ioctl(fd, VIDIOC_G_FMT, &now) == 0 ? now : answer).fmt.pix;
}

void set_rate(V4l2Kernel& kernel, int fd, FrameRate asked, DeviceSettings& settings) {
  v4l2_streamparm wanted{};
  wanted.type = kCapture;
  wanted.parm.capture.timeperframe = interval_of(asked);
  const bool set = kernel.ioctl(fd, VIDIOC_S_PARM, &wanted) == 0;
  v4l2_streamparm now{};
  now.type = kCapture;
  if (kernel.ioctl(fd, VIDIOC_G_PARM, &now) == 0) {
    settings.rate = rate_of(now.parm.capture.timeperframe);
  } else if (set) {
    settings.rate = rate_of(wanted.parm.capture.timeperframe);
  }
  if (settings.rate.hz <= 0.0) {
    settings.differences.push_back(
        "requested " + rate_text(asked) +
        " frames/s, and the driver does not report the actual rate");
  } else if (std::abs(settings.rate.hz - asked.hz) > 0.01 * asked.hz) {
    settings.differences.push_back("requested " + rate_text(asked) + " frames/s, got " +
                                   rate_text(settings.rate));
  }
}

}  // namespace

const char* name(PixelFormat format) {
  switch (format) {
    case PixelFormat::kMjpg:
      return "MJPG";
    case PixelFormat::kYuyv:
      return "YUYV";
    case PixelFormat::kNv12:
      return "NV12";
    case PixelFormat::kGrey:
      return "GREY";
  }
  return "?";
}

std::optional<PixelFormat> format_of(std::uint32_t fourcc) {
  const auto code = std::ranges::find(kCodes, fourcc, &Code::fourcc);
  if (code == kCodes.end()) return std::nullopt;
  return code->format;
}

std::uint32_t fourcc_of(PixelFormat format) {
  return std::ranges::find(kCodes, format, &Code::format)->fourcc;
}

std::string fourcc_text(std::uint32_t fourcc) {
  std::string text;
  for (int i = 0; i < 4; ++i) {
    const auto letter = static_cast<char>(fourcc >> (8 * i) & 0x7FU);
    text += letter >= ' ' && letter <= '~' ? letter : '?';
  }
  return text.substr(0, text.find_last_not_of(' ') + 1);
}

std::vector<DeviceMode> list_modes(V4l2Kernel& kernel, int fd) {
  std::vector<DeviceMode> modes;
  for (std::uint32_t i = 0; i < kMaxEntries; ++i) {
    v4l2_fmtdesc entry{};
    entry.index = i;
    entry.type = kCapture;
    if (kernel.ioctl(fd, VIDIOC_ENUM_FMT, &entry) < 0) break;
    const auto format = format_of(entry.pixelformat);
    if (!format) continue;
    for (const Size& size : list_sizes(kernel, fd, entry.pixelformat)) {
      modes.push_back({*format,
                       static_cast<int>(size.width_px),
                       static_cast<int>(size.height_px),
                       list_rates(kernel, fd, entry.pixelformat, size),
                       entry.pixelformat});
    }
  }
  std::ranges::stable_sort(modes, {}, &DeviceMode::format);
  return modes;
}

std::optional<PixelFormat> choose_format(const DeviceInfo& device,
                                         const DeviceRequest& request) {
  const auto first_with = [&](auto suits) -> std::optional<PixelFormat> {
    for (const PixelFormat format : kPreference) {
      for (const DeviceMode& mode : device.modes) {
        if (mode.format == format && suits(mode)) return format;
      }
    }
    return std::nullopt;
  };
  auto chosen = first_with([&](const DeviceMode& mode) {
    return has_size(mode, request) && has_rate(mode, request);
  });
  if (!chosen) {
    chosen = first_with([&](const DeviceMode& mode) { return has_size(mode, request); });
  }
  return chosen ? chosen : first_with([](const DeviceMode&) { return true; });
}

Status set_format(V4l2Kernel& kernel,
                  int fd,
                  const DeviceRequest& request,
                  PixelFormat format,
                  std::uint32_t fourcc,
                  DeviceSettings& settings) {
  v4l2_format wanted{};
  wanted.type = kCapture;
  wanted.fmt.pix.width = static_cast<std::uint32_t>(request.width_px);
  wanted.fmt.pix.height = static_cast<std::uint32_t>(request.height_px);
  wanted.fmt.pix.pixelformat = fourcc;
  wanted.fmt.pix.field = V4L2_FIELD_NONE;
  if (const int refused = kernel.ioctl(fd, VIDIOC_S_FMT, &wanted); refused < 0) {
    return device_error(request.path, V4l2Step::kSetFormat, -refused);
  }
  const v4l2_pix_format got = read_back(kernel, fd, wanted);
  const auto known = format_of(got.pixelformat);
  if (!known) {
    return Error{Errc::kDevice,
                 request.path,
                 std::string("requested ") + name(format) + ", got " +
                     fourcc_text(got.pixelformat) + ", which marey does not read",
                 "use a camera, or a mode of it, with MJPG, YUYV, NV12 or GREY"};
  }
  if (got.width == 0 || got.height == 0) {
    return Error{Errc::kDevice,
                 request.path,
                 "its driver gives pictures without a size",
                 "unplug the camera and plug it in again"};
  }
  settings.format = *known;
  settings.width_px = static_cast<int>(got.width);
  settings.height_px = static_cast<int>(got.height);
  // Some drivers do not report the length of a row.
  const std::uint32_t row_bytes = (*known == PixelFormat::kYuyv ? 2 : 1) * got.width;
  settings.stride = *known == PixelFormat::kMjpg
                        ? 0
                        : static_cast<int>(std::max(got.bytesperline, row_bytes));
  if (*known != format) {
    settings.differences.push_back(std::string("requested ") + name(format) + ", got " +
                                   name(*known));
  }
  if (settings.width_px != request.width_px || settings.height_px != request.height_px) {
    settings.differences.push_back(
        "requested " + size_of(request.width_px, request.height_px) + ", got " +
        size_of(settings.width_px, settings.height_px));
  }
  set_rate(kernel, fd, request.rate, settings);
  return Done{};
}

}  // namespace marey::capture
