// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/feeds/decode_frame.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include "capture/video/decode_jpeg.h"

namespace marey::capture {
namespace {

/// Copies every `step`-th byte of each row as brightness; the rows of all three
/// uncompressed formats begin with one.
void copy_luma(std::span<const std::byte> bytes,
               const DeviceSettings& settings,
               std::size_t step,
               std::size_t stride,
               std::uint8_t* gray) {
  const auto width = static_cast<std::size_t>(settings.width_px);
  const auto height = static_cast<std::size_t>(settings.height_px);
  for (std::size_t y = 0; y < height; ++y) {
    const std::byte* row = bytes.data() + y * stride;
    std::uint8_t* out = gray + y * width;
    if (step == 1) {
      std::memcpy(out, row, width);
      continue;
    }
    for (std::size_t x = 0; x < width; ++x) {
      out[x] = std::to_integer<std::uint8_t>(row[x * step]);
    }
  }
}

}  // namespace

struct FrameDecoder::Impl {
  std::string name;
  JpegDecoder jpeg;
  std::vector<std::uint8_t> gray;

  [[nodiscard]] Error error(const RawFrame& frame, const std::string& cause) const {
    return {Errc::kDevice,
            name + ": frame " + std::to_string(frame.sequence),
            cause,
            "if this is rare, do nothing: the next frame is not affected; otherwise try "
            "another USB cable or port"};
  }
};

FrameDecoder::FrameDecoder(std::string name)
    : impl_(std::make_unique<Impl>(Impl{std::move(name), {}, {}})) {}
FrameDecoder::FrameDecoder(FrameDecoder&&) noexcept = default;
FrameDecoder& FrameDecoder::operator=(FrameDecoder&&) noexcept = default;
FrameDecoder::~FrameDecoder() = default;

Result<GrayFrame> FrameDecoder::decode(const RawFrame& frame,
                                       const DeviceSettings& settings,
                                       int index) {
  MAREY_ASSERT(settings.width_px > 0 && settings.height_px > 0);
  if (frame.damaged) return impl_->error(frame, "the driver reports that it is damaged");
  const auto width = static_cast<std::size_t>(settings.width_px);
  const auto height = static_cast<std::size_t>(settings.height_px);
  std::vector<std::uint8_t>& gray = impl_->gray;
  gray.resize(width * height);
  if (settings.format == PixelFormat::kMjpg) {
    if (const auto wrong = impl_->jpeg.decode(
            frame.bytes, settings.width_px, settings.height_px, gray.data())) {
      return impl_->error(frame, *wrong);
    }
  } else {
    const std::size_t step = settings.format == PixelFormat::kYuyv ? 2 : 1;
    const std::size_t stride =
        std::max(static_cast<std::size_t>(std::max(settings.stride, 0)), step * width);
    const std::size_t needed = (height - 1) * stride + step * width;
    if (frame.bytes.size() < needed) {
      return impl_->error(frame,
                          "it has " + std::to_string(frame.bytes.size()) + " of " +
                              std::to_string(needed) + " bytes");
    }
    copy_luma(frame.bytes, settings, step, stride, gray.data());
  }
  return GrayFrame{
      gray.data(), settings.width_px, settings.height_px, settings.width_px, index};
}

}  // namespace marey::capture
