// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/video/read_image.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <ios>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include <libexif/exif-data.h>
#include <opencv2/core.hpp>
#include <turbojpeg.h>

#include "capture/video/decode_png.h"
#include "core/base/assert.h"
#include "core/base/input_file.h"

namespace marey::capture {
namespace {

std::vector<char> bytes_of(const std::filesystem::path& path) {
  if (!check_input_file(path)) return {};
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  if (!in) return {};
  const std::streamoff size = in.tellg();
  if (size <= 0) return {};
  std::vector<char> bytes(static_cast<std::size_t>(size));
  in.seekg(0);
  if (!in.read(bytes.data(), size)) return {};
  return bytes;
}

/// Returns true if an image file lacks its end: TurboJPEG would fill in the missing part.
/// A PNG ends with its IEND chunk; a JPEG's last scan (FF DA) ends with the end mark
/// (FF D9), and neither can occur inside a scan.
bool is_cut_short(const std::vector<char>& bytes) {
  using namespace std::string_view_literals;
  const std::string_view text(bytes.data(), bytes.size());
  if (text.substr(0, 4) == "\x89PNG"sv) return text.rfind("IEND"sv) == text.npos;
  if (text.substr(0, 2) != "\xFF\xD8"sv) return false;
  const std::size_t scan = text.rfind("\xFF\xDA"sv);
  const std::size_t end = text.rfind("\xFF\xD9"sv);
  return scan == text.npos || end == text.npos || end < scan;
}

/// Returns the number of pixels in the header of a PNG or JPEG; 0 if there is none.
std::uint64_t declared_pixels(const std::vector<char>& bytes) {
  const auto word = [&](std::size_t at, std::size_t size) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) {
      value = value << 8U | static_cast<unsigned char>(bytes[at + i]);
    }
    return value;
  };
  const std::size_t size = bytes.size();
  // Length and name of the first chunk, then width and height.
  if (size >= 24 && word(0, 4) == 0x89504e47U) return word(16, 4) * word(20, 4);
  if (size < 2 || word(0, 2) != 0xffd8U) return 0;
  std::uint64_t maximum = 0;
  for (std::size_t at = 2; size - at >= 9 && word(at, 1) == 0xffU;) {
    const std::uint64_t mark = word(at + 1, 1);
    if (mark == 0xffU) {
      ++at;  // A mark may begin with any number of them.
      continue;
    }
    // A frame header; excludes the tables 0xc4, 0xc8 and 0xcc.
    const bool is_frame = mark >= 0xc0U && mark <= 0xcfU && mark % 4 != 0;
    if (is_frame || mark == 0xc0U)
      maximum = std::max(maximum, word(at + 5, 2) * word(at + 7, 2));
    if (mark == 0xdaU || word(at + 2, 2) + 2 > size - at) break;
    at += static_cast<std::size_t>(word(at + 2, 2)) + 2;
  }
  return maximum;
}

struct DestroyJpeg {
  void operator()(void* handle) const { tjDestroy(handle); }
};
struct FreeExif {
  void operator()(ExifData* data) const { exif_data_unref(data); }
};

/// Returns EXIF's orientation, 1 to 8; 1 is upright.
int orientation_of(std::span<const unsigned char> jpeg) {
  const std::unique_ptr<ExifData, FreeExif> data(
      exif_data_new_from_data(jpeg.data(), static_cast<unsigned>(jpeg.size())));
  if (!data) return 1;
  const ExifEntry* entry =
      exif_content_get_entry(data->ifd[EXIF_IFD_0], EXIF_TAG_ORIENTATION);
  if (entry == nullptr || entry->format != EXIF_FORMAT_SHORT || entry->size < 2) return 1;
  return exif_get_short(entry->data, exif_data_get_byte_order(data.get()));
}

/// Turns an image with an EXIF orientation upright.
cv::Mat upright(const cv::Mat& image, int orientation) {
  if (orientation < 2 || orientation > 8) return image;
  cv::Mat turned = image;
  if (orientation >= 5) cv::transpose(image, turned);
  constexpr int kNone = 2;
  constexpr int kUpsideDown = 0;
  constexpr int kMirrored = 1;
  constexpr int kBoth = -1;
  constexpr std::array<int, 7> kFlips{
      kMirrored, kBoth, kUpsideDown, kNone, kMirrored, kBoth, kUpsideDown};
  const int flip = kFlips[static_cast<std::size_t>(orientation - 2)];
  cv::Mat flipped;
  if (flip == kNone) return turned;
  cv::flip(turned, flipped, flip);
  return flipped;
}

cv::Mat decode_jpeg(std::span<const unsigned char> bytes, ImageColours colours) {
  const std::unique_ptr<void, DestroyJpeg> jpeg(tjInitDecompress());
  const auto size = static_cast<unsigned long>(bytes.size());
  int width = 0;
  int height = 0;
  int sampling = 0;
  int space = 0;
  // Also sets the size where it does not know the sampling of the colours.
  static_cast<void>(tjDecompressHeader3(
      jpeg.get(), bytes.data(), size, &width, &height, &sampling, &space));
  if (width < 1 || height < 1) return {};
  const bool grey = colours == ImageColours::kGrey;
  cv::Mat image(height, width, grey ? CV_8UC1 : CV_8UC3);
  const int failed = tjDecompress2(jpeg.get(),
                                   bytes.data(),
                                   size,
                                   image.data,
                                   width,
                                   static_cast<int>(image.step[0]),
                                   height,
                                   grey ? TJPF_GRAY : TJPF_BGR,
                                   TJFLAG_ACCURATEDCT);
  if (failed != 0 && tjGetErrorCode(jpeg.get()) != TJERR_WARNING) return {};
  return upright(image, orientation_of(bytes));
}

cv::Mat decode(const std::vector<char>& bytes, ImageColours colours) {
  const std::span<const unsigned char> raw(
      reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  const bool is_png = std::string_view(bytes.data(), bytes.size()).starts_with("\x89PNG");
  return is_png ? decode_png(raw, colours) : decode_jpeg(raw, colours);
}

}  // namespace

Result<cv::Mat> read_image(const std::filesystem::path& path,
                           ImageColours colours,
                           const std::string& name) {
  cv::Mat image;
  try {
    const std::vector<char> bytes = bytes_of(path);
    constexpr std::uint64_t kMaxPixels = 200'000'000;
    if (declared_pixels(bytes) > kMaxPixels) {
      return bad_input(name,
                       "the image header states more than 200 million pixels",
                       "copy it from the camera again, or remove it");
    }
    if (!bytes.empty() && !is_cut_short(bytes)) image = decode(bytes, colours);
  } catch (const cv::Exception&) {
    image.release();
  }
  if (image.empty()) {
    return bad_input(
        name, "the image cannot be read", "copy it from the camera again, or remove it");
  }
  return image;
}

GrayFrame view_of(const cv::Mat& gray, int index) {
  MAREY_ASSERT(gray.type() == CV_8UC1);
  return {gray.data, gray.cols, gray.rows, static_cast<int>(gray.step[0]), index};
}

std::string size_text(int width_px, int height_px) {
  return std::to_string(width_px) + "x" + std::to_string(height_px);
}

}  // namespace marey::capture
