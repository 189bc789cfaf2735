// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/video/decode_png.h"

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <vector>

#include <png.h>

namespace marey::capture {
namespace {

struct PngReading {
  std::span<const unsigned char> rest;  ///< Bytes that are not yet read.
  png_structp png = nullptr;
  png_infop info = nullptr;
  cv::Mat image;
  std::vector<png_bytep> rows;

  PngReading() = default;
  PngReading(const PngReading&) = delete;
  PngReading& operator=(const PngReading&) = delete;
  ~PngReading() { png_destroy_read_struct(&png, &info, nullptr); }
};

void give_bytes(png_structp png, png_bytep to, std::size_t count) {
  auto& reading = *static_cast<PngReading*>(png_get_io_ptr(png));
  if (count > reading.rest.size()) png_error(png, "it ends early");
  std::memcpy(to, reading.rest.data(), count);
  reading.rest = reading.rest.subspan(count);
}

/// Converts to 8 bits per channel and to the channels of `colours`.
void set_conversions(PngReading& reading, ImageColours colours) {
  png_structp png = reading.png;
  const int kind = png_get_color_type(png, reading.info);
  const int bits = png_get_bit_depth(png, reading.info);
  if (bits == 16) png_set_strip_16(png);
  png_set_strip_alpha(png);
  if (kind == PNG_COLOR_TYPE_PALETTE) png_set_palette_to_rgb(png);
  const bool coloured = (kind & PNG_COLOR_MASK_COLOR) != 0;
  if (!coloured && bits < 8) png_set_expand_gray_1_2_4_to_8(png);
  if (colours == ImageColours::kGrey) {
    constexpr int kWithoutWarning = 1;
    png_set_rgb_to_gray(png, kWithoutWarning, 0.299, 0.587);
  } else if (coloured) {
    png_set_bgr(png);
  } else {
    png_set_gray_to_rgb(png);
  }
  png_set_interlace_handling(png);
}

/// Target of setjmp(): no object with a destructor may be used here.
bool read_png(PngReading& reading, ImageColours colours) {
  // NOLINTNEXTLINE(modernize-avoid-setjmp-longjmp): libpng's only way out.
  if (setjmp(png_jmpbuf(reading.png)) != 0) return false;
  png_set_read_fn(reading.png, &reading, give_bytes);
  png_read_info(reading.png, reading.info);
  set_conversions(reading, colours);
  png_read_update_info(reading.png, reading.info);
  const int channels = colours == ImageColours::kGrey ? 1 : 3;
  if (png_get_channels(reading.png, reading.info) != channels) return false;
  reading.image.create(static_cast<int>(png_get_image_height(reading.png, reading.info)),
                       static_cast<int>(png_get_image_width(reading.png, reading.info)),
                       CV_8UC(channels));
  reading.rows.resize(static_cast<std::size_t>(reading.image.rows));
  for (int y = 0; y < reading.image.rows; ++y) {
    reading.rows[static_cast<std::size_t>(y)] = reading.image.ptr(y);
  }
  png_read_image(reading.png, reading.rows.data());
  png_read_end(reading.png, nullptr);
  return true;
}

}  // namespace

cv::Mat decode_png(std::span<const unsigned char> bytes, ImageColours colours) {
  PngReading reading;
  reading.rest = bytes;
  // Without messages: both functions would print.
  reading.png = png_create_read_struct(
      PNG_LIBPNG_VER_STRING,
      nullptr,
      [](png_structp png, png_const_charp) { png_longjmp(png, 1); },
      [](png_structp, png_const_charp) {});
  if (reading.png == nullptr) return {};
  reading.info = png_create_info_struct(reading.png);
  if (reading.info == nullptr || !read_png(reading, colours)) return {};
  return reading.image;
}

}  // namespace marey::capture
