// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/video/mjpg_file.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "capture/video/decode_jpeg.h"
#include "capture/video/read_image.h"
#include "capture/video/video_reader.h"
#include "core/base/extension.h"

namespace marey::capture {
namespace {

using Bytes = std::span<const std::byte>;

constexpr std::uint8_t kGrey = 128;

int at(Bytes bytes, std::size_t i) {
  return std::to_integer<int>(bytes[i]);
}

bool is_jpeg(Bytes bytes) {
  return bytes.size() >= 4 && at(bytes, 0) == 0xFF && at(bytes, 1) == 0xD8 &&
         at(bytes, 2) == 0xFF;
}

/// Returns the size in the header of a JPEG image: ITU-T T.81, B.2.2 (SOF0 to SOF2).
std::optional<cv::Size> size_in_header(Bytes bytes) {
  constexpr int kFirstFrameMark = 0xC0;
  constexpr int kLastFrameMark = 0xC2;
  constexpr int kScanMark = 0xDA;
  std::size_t i = 2;
  while (i + 9 < bytes.size() && at(bytes, i) == 0xFF) {
    const int mark = at(bytes, i + 1);
    if (mark >= kFirstFrameMark && mark <= kLastFrameMark) {
      return cv::Size((at(bytes, i + 7) << 8) + at(bytes, i + 8),
                      (at(bytes, i + 5) << 8) + at(bytes, i + 6));
    }
    if (mark == kScanMark) return std::nullopt;
    i += 2 + static_cast<std::size_t>((at(bytes, i + 2) << 8) + at(bytes, i + 3));
  }
  return std::nullopt;
}

/// Tests the first frames, as any of them may be damaged.
bool holds_jpeg(const std::filesystem::path& path) {
  constexpr int kAsked = 10;
  auto video = VideoReader::open_packets(path);
  for (int i = 0; video && i < kAsked; ++i) {
    const auto packet = video->next_packet();
    if (!packet) return false;
    if (is_jpeg(*packet)) return true;
  }
  return false;
}

class MjpgFile final : public FrameSource {
 public:
  MjpgFile(VideoReader video, StreamInfo info, int min_frames)
      : video_(std::move(video)), info_(std::move(info)), min_frames_(min_frames) {
    gray_.create(info_.height_px, info_.width_px, CV_8UC1);
  }

  [[nodiscard]] const StreamInfo& info() const override { return info_; }

  Result<std::optional<GrayFrame>> next() override {
    const auto packet = video_.next_packet();
    if (!packet) return at_end();
    const Bytes jpeg = *packet;
    const auto wrong = decoder_.decode(jpeg, info_.width_px, info_.height_px, gray_.data);
    if (wrong) {
      const auto size = is_jpeg(jpeg) ? size_in_header(jpeg) : std::nullopt;
      if (size && size->area() > 0 && *size != gray_.size()) return changed(*size);
      gray_.setTo(cv::Scalar::all(kGrey));
      ++damaged_;
    }
    GrayFrame frame = view_of(gray_, index_++);
    frame.damaged = wrong.has_value();
    return std::optional(frame);
  }

 private:
  [[nodiscard]] Error changed(const cv::Size& size) const {
    return bad_input(info_.name + ": frame " + std::to_string(index_),
                     "the picture changes its size to " +
                         size_text(size.width, size.height) + ", the video began with " +
                         size_text(info_.width_px, info_.height_px),
                     "record with one size, or cut the video there");
  }

  [[nodiscard]] Result<std::optional<GrayFrame>> at_end() const {
    if (damaged_ == index_) {
      return bad_input(
          info_.name,
          "not one of its " + std::to_string(index_) + " frames can be decoded",
          "copy the file from the camera again");
    }
    if (index_ >= min_frames_) return std::optional<GrayFrame>();
    return bad_input(info_.name,
                     "the video ends after " + std::to_string(index_) + " of " +
                         std::to_string(info_.expected_frames.value_or(min_frames_)) +
                         " frames",
                     "copy the file from the camera again");
  }

  VideoReader video_;
  StreamInfo info_;
  int min_frames_;
  JpegDecoder decoder_;
  cv::Mat gray_;
  int index_ = 0;
  int damaged_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> open_mjpg_file(const std::filesystem::path& path,
                                            const std::string& name) {
  if (!holds_jpeg(path)) return nullptr;
  auto video = VideoReader::open_packets(path);
  if (!video) return nullptr;
  const VideoFacts& facts = video->facts();
  StreamInfo info;
  info.name = name;
  info.width_px = facts.width_px;
  info.height_px = facts.height_px;
  if (facts.rate_hz > 0.0) info.rate = FrameRate{facts.rate_hz};
  if (info.width_px <= 0 || info.height_px <= 0) return nullptr;
  int min_frames = 1;
  if (facts.frames >= 1.0 && facts.frames < 1e9) {
    const int promised = static_cast<int>(std::lround(facts.frames));
    info.expected_frames = promised;
    // AVI stores its number of frames. Matroska stores at most a duration, in which
    // frames dropped by the camera are not included.
    if (kind_by_extension(path) == ".avi")
      min_frames = promised - std::max(2, promised / 50);
  }
  return std::make_unique<MjpgFile>(*std::move(video), std::move(info), min_frames);
}

}  // namespace marey::capture
