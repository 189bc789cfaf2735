// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/takes/jpeg_encoder.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "core/base/assert.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavutil/frame.h>
}

namespace marey::recordings {
namespace {

/// JPEG's second finest quantization: twice the size of a camera's own JPEG.
constexpr int kQuality = 2;
constexpr std::uint8_t kNoChroma = 128;

std::uint8_t grey(std::byte value) {
  return std::to_integer<std::uint8_t>(value);
}

}  // namespace

struct JpegEncoder::Impl {
  RawLayout layout = RawLayout::kGrey;
  std::size_t width = 0;
  std::size_t height = 0;
  std::size_t stride = 0;
  AVCodecContext* codec = nullptr;
  AVFrame* picture = av_frame_alloc();
  AVPacket* packet = av_packet_alloc();

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    avcodec_free_context(&codec);
    av_frame_free(&picture);
    av_packet_free(&packet);
  }

  [[nodiscard]] bool open();
  [[nodiscard]] std::size_t raw_size() const;
  [[nodiscard]] std::uint8_t* row(int plane, std::size_t y) const {
    return picture->data[plane] + y * static_cast<std::size_t>(picture->linesize[plane]);
  }
  void fill(std::span<const std::byte> raw) const;
  void fill_yuyv(std::span<const std::byte> raw) const;
  void fill_planes(std::span<const std::byte> raw) const;
};

bool JpegEncoder::Impl::open() {
  const AVCodec* encoder = avcodec_find_encoder(AV_CODEC_ID_MJPEG);
  codec = encoder != nullptr ? avcodec_alloc_context3(encoder) : nullptr;
  if (codec == nullptr || picture == nullptr || packet == nullptr) return false;
  codec->width = static_cast<int>(width);
  codec->height = static_cast<int>(height);
  codec->time_base = {1, 1000};
  codec->pix_fmt = layout == RawLayout::kYuyv ? AV_PIX_FMT_YUVJ422P : AV_PIX_FMT_YUVJ420P;
  codec->flags |= AV_CODEC_FLAG_QSCALE;
  codec->global_quality = kQuality * FF_QP2LAMBDA;
  codec->thread_count = 1;
  if (avcodec_open2(codec, encoder, nullptr) < 0) return false;
  picture->format = codec->pix_fmt;
  picture->width = codec->width;
  picture->height = codec->height;
  picture->quality = codec->global_quality;
  return av_frame_get_buffer(picture, 0) >= 0;
}

std::size_t JpegEncoder::Impl::raw_size() const {
  const std::size_t last_row = layout == RawLayout::kYuyv ? 2 * width : width;
  const std::size_t rows = layout == RawLayout::kNv12 ? height + height / 2 : height;
  return (rows - 1) * stride + last_row;
}

void JpegEncoder::Impl::fill(std::span<const std::byte> raw) const {
  if (layout == RawLayout::kYuyv) {
    fill_yuyv(raw);
  } else {
    fill_planes(raw);
  }
}

void JpegEncoder::Impl::fill_yuyv(std::span<const std::byte> raw) const {
  for (std::size_t y = 0; y < height; ++y) {
    const std::byte* in = raw.data() + y * stride;
    std::uint8_t* const luma = row(0, y);
    std::uint8_t* const u = row(1, y);
    std::uint8_t* const v = row(2, y);
    for (std::size_t x = 0; x < width / 2; ++x, in += 4) {
      luma[2 * x] = grey(in[0]);
      u[x] = grey(in[1]);
      luma[2 * x + 1] = grey(in[2]);
      v[x] = grey(in[3]);
    }
  }
}

void JpegEncoder::Impl::fill_planes(std::span<const std::byte> raw) const {
  for (std::size_t y = 0; y < height; ++y) {
    const std::byte* const in = raw.data() + y * stride;
    std::transform(in, in + width, row(0, y), grey);
  }
  for (std::size_t y = 0; y < (height + 1) / 2; ++y) {
    std::uint8_t* const u = row(1, y);
    std::uint8_t* const v = row(2, y);
    if (layout == RawLayout::kGrey) {
      std::fill_n(u, width / 2, kNoChroma);
      std::fill_n(v, width / 2, kNoChroma);
      continue;
    }
    const std::byte* in = raw.data() + (height + y) * stride;
    for (std::size_t x = 0; x < width / 2; ++x, in += 2) {
      u[x] = grey(in[0]);
      v[x] = grey(in[1]);
    }
  }
}

JpegEncoder::JpegEncoder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
JpegEncoder::JpegEncoder(JpegEncoder&&) noexcept = default;
JpegEncoder& JpegEncoder::operator=(JpegEncoder&&) noexcept = default;
JpegEncoder::~JpegEncoder() = default;

Result<JpegEncoder> JpegEncoder::create(RawLayout layout,
                                        int width_px,
                                        int height_px,
                                        int stride) {
  MAREY_ASSERT(width_px > 0 && width_px % 2 == 0 && height_px > 0);
  MAREY_ASSERT(layout != RawLayout::kNv12 || height_px % 2 == 0);
  MAREY_ASSERT(stride >= (layout == RawLayout::kYuyv ? 2 : 1) * width_px);
  auto impl = std::make_unique<Impl>();
  impl->layout = layout;
  impl->width = static_cast<std::size_t>(width_px);
  impl->height = static_cast<std::size_t>(height_px);
  impl->stride = static_cast<std::size_t>(stride);
  if (!impl->open()) {
    return Error{Errc::kInternal,
                 "",
                 "libavcodec cannot encode JPEG",
                 "install Debian's libavcodec59, or a camera that sends MJPG"};
  }
  return JpegEncoder(std::move(impl));
}

std::span<const std::byte> JpegEncoder::encode(std::span<const std::byte> raw) {
  Impl& impl = *impl_;
  if (raw.size() < impl.raw_size()) return {};
  if (av_frame_make_writable(impl.picture) < 0) return {};
  impl.fill(raw);
  ++impl.picture->pts;
  av_packet_unref(impl.packet);
  if (avcodec_send_frame(impl.codec, impl.picture) < 0) return {};
  if (avcodec_receive_packet(impl.codec, impl.packet) < 0) return {};
  return std::as_bytes(
      std::span(impl.packet->data, static_cast<std::size_t>(impl.packet->size)));
}

}  // namespace marey::recordings
