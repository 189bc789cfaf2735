// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/takes/jpeg_encoder.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include <turbojpeg.h>

#include "core/base/assert.h"

namespace marey::recordings {
namespace {

/// About twice the size of a camera's own JPEG.
constexpr int kQuality = 92;

const unsigned char* bytes_at(std::span<const std::byte> raw, std::size_t at) {
  return reinterpret_cast<const unsigned char*>(raw.data()) + at;
}

struct DestroyHandle {
  void operator()(void* handle) const { tjDestroy(handle); }
};

}  // namespace

struct JpegEncoder::Impl {
  RawLayout layout = RawLayout::kGrey;
  std::size_t width = 0;
  std::size_t height = 0;
  std::size_t stride = 0;
  std::unique_ptr<void, DestroyHandle> codec{tjInitCompress()};
  int sampling = TJSAMP_GRAY;
  std::vector<unsigned char> luma;  ///< Planes that the raw frame does not have.
  std::vector<unsigned char> u;
  std::vector<unsigned char> v;
  std::vector<unsigned char> jpeg;

  [[nodiscard]] std::size_t raw_size() const;
  void split_yuyv(std::span<const std::byte> raw);
  void split_uv(std::span<const std::byte> raw);
};

std::size_t JpegEncoder::Impl::raw_size() const {
  const std::size_t last_row = layout == RawLayout::kYuyv ? 2 * width : width;
  const std::size_t rows = layout == RawLayout::kNv12 ? height + height / 2 : height;
  return (rows - 1) * stride + last_row;
}

void JpegEncoder::Impl::split_yuyv(std::span<const std::byte> raw) {
  for (std::size_t y = 0; y < height; ++y) {
    const unsigned char* in = bytes_at(raw, y * stride);
    for (std::size_t x = 0; x < width / 2; ++x, in += 4) {
      const std::size_t at = y * width / 2 + x;
      luma[2 * at] = in[0];
      u[at] = in[1];
      luma[2 * at + 1] = in[2];
      v[at] = in[3];
    }
  }
}

void JpegEncoder::Impl::split_uv(std::span<const std::byte> raw) {
  for (std::size_t y = 0; y < height / 2; ++y) {
    const unsigned char* in = bytes_at(raw, (height + y) * stride);
    for (std::size_t x = 0; x < width / 2; ++x, in += 2) {
      u[y * width / 2 + x] = in[0];
      v[y * width / 2 + x] = in[1];
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
  if (layout == RawLayout::kYuyv) {
    impl->sampling = TJSAMP_422;
    impl->luma.resize(impl->width * impl->height);
    impl->u.resize(impl->luma.size() / 2);
  } else if (layout == RawLayout::kNv12) {
    impl->sampling = TJSAMP_420;
    impl->u.resize(impl->width * impl->height / 4);
  }
  impl->v.resize(impl->u.size());
  impl->jpeg.resize(tjBufSize(width_px, height_px, impl->sampling));
  if (impl->codec == nullptr) {
    return Error{Errc::kInternal,
                 "",
                 "TurboJPEG cannot encode: " + std::string(tjGetErrorStr2(nullptr)),
                 "close other programs, as memory is probably short"};
  }
  return JpegEncoder(std::move(impl));
}

std::span<const std::byte> JpegEncoder::encode(std::span<const std::byte> raw) {
  Impl& impl = *impl_;
  if (raw.size() < impl.raw_size()) return {};
  const auto width = static_cast<int>(impl.width);
  std::array<const unsigned char*, 3> planes{
      bytes_at(raw, 0), impl.u.data(), impl.v.data()};
  std::array<int, 3> strides{static_cast<int>(impl.stride), width / 2, width / 2};
  if (impl.layout == RawLayout::kYuyv) {
    impl.split_yuyv(raw);
    planes[0] = impl.luma.data();
    strides[0] = width;
  } else if (impl.layout == RawLayout::kNv12) {
    impl.split_uv(raw);
  }
  unsigned char* jpeg = impl.jpeg.data();
  unsigned long size = impl.jpeg.size();
  const int failed = tjCompressFromYUVPlanes(impl.codec.get(),
                                             planes.data(),
                                             width,
                                             strides.data(),
                                             static_cast<int>(impl.height),
                                             impl.sampling,
                                             &jpeg,
                                             &size,
                                             kQuality,
                                             TJFLAG_NOREALLOC | TJFLAG_ACCURATEDCT);
  if (failed != 0) return {};
  return std::as_bytes(std::span(jpeg, size));
}

}  // namespace marey::recordings
