// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/video/opencv_reading.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <ios>
#include <string_view>
#include <vector>

#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/base/input_file.h"

namespace marey::capture {
namespace {

void silence_opencv() {
  static const bool once = [] {
    // FFmpeg's AV_LOG_QUIET; read by OpenCV when it first opens a video. An existing
    // setting of a developer is kept.
    // NOLINTNEXTLINE(concurrency-mt-unsafe): once, before any worker has started.
    ::setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", /*overwrite=*/0);
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    return true;
  }();
  static_cast<void>(once);
}

Error cannot_open(const std::string& name) {
  return bad_input(name,
                   "it cannot be opened as a video: it is not one, or its index is "
                   "missing because the copy or the recording was cut short",
                   "play it in a video player; if that fails too, copy it from the "
                   "camera again");
}

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

/// Returns true if an image file lacks its end: OpenCV would return the existing part,
/// and libpng would print to standard error. A PNG ends with its IEND chunk; a JPEG's
/// last scan (FF DA) ends with the end mark (FF D9), and neither can occur inside a scan.
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
  std::uint64_t most = 0;
  for (std::size_t at = 2; size - at >= 9 && word(at, 1) == 0xffU;) {
    const std::uint64_t mark = word(at + 1, 1);
    if (mark == 0xffU) {
      ++at;  // A mark may begin with any number of them.
      continue;
    }
    // A frame header; excludes the tables 0xc4, 0xc8 and 0xcc.
    const bool is_frame = mark >= 0xc0U && mark <= 0xcfU && mark % 4 != 0;
    if (is_frame || mark == 0xc0U)
      most = std::max(most, word(at + 5, 2) * word(at + 7, 2));
    if (mark == 0xdaU || word(at + 2, 2) + 2 > size - at) break;
    at += static_cast<std::size_t>(word(at + 2, 2)) + 2;
  }
  return most;
}

/// FFmpeg interprets names as URLs: "a:b.mkv" would have the protocol "a".
std::string url_of(const std::filesystem::path& path) {
  return "file:" + path.string();
}

}  // namespace

Result<cv::VideoCapture> open_capture(const std::filesystem::path& path,
                                      const std::string& name) {
  if (const Status ok = check_input_file(path, name); !ok) return ok.error();
  silence_opencv();
  try {
    cv::VideoCapture video(url_of(path), cv::CAP_FFMPEG);
    if (!video.isOpened()) return cannot_open(name);
    return video;
  } catch (const cv::Exception&) {
    return cannot_open(name);
  }
}

std::optional<cv::VideoCapture> open_packets(const std::filesystem::path& path) {
  if (!check_input_file(path)) return std::nullopt;
  silence_opencv();
  try {
    cv::VideoCapture video(url_of(path), cv::CAP_FFMPEG, {cv::CAP_PROP_FORMAT, -1});
    if (!video.isOpened()) return std::nullopt;
    return video;
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
}

Result<cv::Mat> read_image(const std::filesystem::path& path,
                           int mode,
                           const std::string& name) {
  silence_opencv();
  cv::Mat image;
  try {
    // Decoded from memory: a truncated file then fails, where imread() would pad it.
    const std::vector<char> bytes = bytes_of(path);
    constexpr std::uint64_t kMaxPixels = 200'000'000;
    if (declared_pixels(bytes) > kMaxPixels) {
      return bad_input(name,
                       "the image header states more than 200 million pixels",
                       "copy it from the camera again, or remove it");
    }
    if (!bytes.empty() && !is_cut_short(bytes)) image = cv::imdecode(bytes, mode);
  } catch (const cv::Exception&) {
    image.release();
  }
  if (image.empty()) {
    return bad_input(
        name, "the image cannot be read", "copy it from the camera again, or remove it");
  }
  return image;
}

void to_gray(const cv::Mat& image, cv::Mat& gray) {
  if (image.channels() == 1) {
    image.copyTo(gray);
  } else {
    cv::cvtColor(image, gray, cv::COLOR_BGR2GRAY);
  }
}

GrayFrame view_of(const cv::Mat& gray, int index) {
  MAREY_ASSERT(gray.type() == CV_8UC1);
  return {gray.data, gray.cols, gray.rows, static_cast<int>(gray.step[0]), index};
}

std::string size_text(int width_px, int height_px) {
  return std::to_string(width_px) + "x" + std::to_string(height_px);
}

}  // namespace marey::capture
