// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/app/broken_video.h"

#include <cmath>
#include <cstdint>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "tests/support/files/text_file.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;

void write_part(const std::string& bytes, const fs::path& to, double share) {
  const auto size =
      static_cast<std::size_t>(std::floor(share * static_cast<double>(bytes.size())));
  std::ofstream(to, std::ios::binary) << bytes.substr(0, size);
}

/// Size of the MP4 box that begins at `place`: four bytes, the highest first.
std::size_t box_size(const std::string& bytes, std::size_t place) {
  std::size_t size = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    size = size * 256 + static_cast<std::uint8_t>(bytes.at(place + i));
  }
  if (size < 8) throw std::runtime_error("an MP4 box of an unexpected kind");
  return size;
}

cv::VideoCapture opened(const fs::path& video) {
  cv::VideoCapture in(video.string(), cv::CAP_FFMPEG);
  if (!in.isOpened()) throw std::runtime_error("cannot read " + video.string());
  return in;
}

cv::VideoWriter writer_like(const cv::VideoCapture& in, const fs::path& to) {
  const cv::Size size(static_cast<int>(in.get(cv::CAP_PROP_FRAME_WIDTH)),
                      static_cast<int>(in.get(cv::CAP_PROP_FRAME_HEIGHT)));
  cv::VideoWriter out(to.string(),
                      cv::CAP_FFMPEG,
                      cv::VideoWriter::fourcc('m', 'p', '4', 'v'),
                      in.get(cv::CAP_PROP_FPS),
                      size);
  if (!out.isOpened()) throw std::runtime_error("cannot write " + to.string());
  return out;
}

}  // namespace

void copy_part(const fs::path& from, const fs::path& to, double share) {
  write_part(read_text(from), to, share);
}

void copy_part_without_index(const fs::path& from, const fs::path& to, double share) {
  const std::string bytes = read_text(from);
  std::string others;
  std::string index;
  for (std::size_t place = 0; place < bytes.size();) {
    const std::size_t size = box_size(bytes, place);
    (bytes.compare(place + 4, 4, "moov") == 0 ? index : others) +=
        bytes.substr(place, size);
    place += size;
  }
  if (index.empty()) throw std::runtime_error("no index in " + from.string());
  write_part(others + index, to, share);
}

void write_grey_video(const fs::path& like, const fs::path& to, int frames) {
  const cv::VideoCapture in = opened(like);
  cv::VideoWriter out = writer_like(in, to);
  const cv::Mat grey(static_cast<int>(in.get(cv::CAP_PROP_FRAME_HEIGHT)),
                     static_cast<int>(in.get(cv::CAP_PROP_FRAME_WIDTH)),
                     CV_8UC3,
                     cv::Scalar::all(128));
  for (int i = 0; i < frames; ++i) out.write(grey);
}

void copy_with_blanks(const fs::path& from,
                      const fs::path& to,
                      const std::function<bool(int frame)>& is_kept) {
  cv::VideoCapture in = opened(from);
  cv::VideoWriter out = writer_like(in, to);
  cv::Mat picture;
  for (int frame = 0; in.read(picture); ++frame) {
    if (!is_kept(frame)) picture.setTo(cv::Scalar::all(128));
    out.write(picture);
  }
}

void copy_late(const fs::path& from, const fs::path& to, int late) {
  cv::VideoCapture in = opened(from);
  cv::VideoWriter out = writer_like(in, to);
  cv::Mat picture;
  for (int frame = 0; in.read(picture); ++frame) {
    if (frame >= late) out.write(picture);
  }
}

void copy_turned(const fs::path& from, const fs::path& to, int degrees, int frames) {
  cv::VideoCapture in = opened(from);
  std::optional<cv::VideoWriter> out;
  cv::Mat picture;
  cv::Mat turned;
  for (int frame = 0; frame < frames && in.read(picture); ++frame) {
    cv::rotate(
        picture, turned, degrees == 180 ? cv::ROTATE_180 : cv::ROTATE_90_CLOCKWISE);
    if (!out) {
      out.emplace(to.string(),
                  cv::CAP_FFMPEG,
                  cv::VideoWriter::fourcc('m', 'p', '4', 'v'),
                  in.get(cv::CAP_PROP_FPS),
                  turned.size());
      if (!out->isOpened()) throw std::runtime_error("cannot write " + to.string());
    }
    out->write(turned);
  }
}

void copy_marked_upside_down(const fs::path& from, const fs::path& to) {
  // ISO/IEC 14496-12, 8.3.2: the matrix is 40 bytes behind the type of a track's header.
  std::string bytes = read_text(from);
  const std::size_t header = bytes.find("tkhd");
  if (header == std::string::npos)
    throw std::runtime_error("no track in " + from.string());
  for (const std::size_t element : {0U, 4U}) {
    const std::size_t place = header + 4 + 40 + 4 * element;
    bytes.replace(place, 4, std::string("\xFF\xFF\x00\x00", 4));  // -1 in 16.16.
  }
  write_part(bytes, to, 1.0);
}

void write_images_with_a_gap(const fs::path& like, const fs::path& folder) {
  const cv::VideoCapture in = opened(like);
  fs::create_directories(folder);
  const cv::Mat grey(static_cast<int>(in.get(cv::CAP_PROP_FRAME_HEIGHT)),
                     static_cast<int>(in.get(cv::CAP_PROP_FRAME_WIDTH)),
                     CV_8UC1,
                     cv::Scalar::all(128));
  for (int i = 0; i < 13; ++i) {
    if (i == 7 || i == 8) continue;
    const std::string number = std::to_string(1000 + i).substr(1);
    cv::imwrite((folder / ("frame_" + number + ".png")).string(), grey);
  }
}

}  // namespace marey::testing
