// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/video/video_file.h"

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "capture/video/mjpg_file.h"
#include "capture/video/read_image.h"
#include "capture/video/video_reader.h"
#include "core/base/extension.h"

namespace marey::capture {
namespace {

/// Minimum number of frames of a complete video, and the number in its header.
struct Promise {
  int expected = 0;
  int min_frames = 0;
};

std::optional<Promise> promise_of(const std::filesystem::path& path,
                                  const VideoFacts& facts) {
  if (!(facts.frames >= 1.0) || facts.frames > 1e9) return std::nullopt;
  const int stored = static_cast<int>(std::lround(facts.frames));
  if (!is_mp4(path)) {
    // Here the number is the product of a rounded duration and a rounded rate.
    return Promise{stored, stored - std::max(2, stored / 50)};
  }
  // An edit list hides some of the stored frames; only the duration considers it.
  const int shown = static_cast<int>(std::lround(facts.duration_s * facts.rate_hz));
  if (shown >= stored || shown < 1) return Promise{stored, stored};
  return Promise{shown, shown - 1};
}

class VideoFile final : public FrameSource {
 public:
  VideoFile(VideoReader video, StreamInfo info, int min_frames)
      : video_(std::move(video)), info_(std::move(info)), min_frames_(min_frames) {}

  [[nodiscard]] const StreamInfo& info() const override { return info_; }

  Result<std::optional<GrayFrame>> next() override {
    try {
      return read_next();
    } catch (const cv::Exception& e) {
      return bad_input(where(), e.err, "convert the video to H.264 in MP4 and try again");
    }
  }

 private:
  Result<std::optional<GrayFrame>> read_next() {
    if (!video_.grab()) return at_end();
    const cv::Size stored(video_.facts().width_px, video_.facts().height_px);
    const cv::Size size = video_.grabbed_size();
    if (index_ == 0) first_size_ = size;
    const bool too_small = size.width < stored.width || size.height < stored.height;
    if (too_small || size != first_size_) {
      return bad_input(where(),
                       "the picture changes its size to " + size_text(size) +
                           ", the video began with " + size_text(stored),
                       "record with one size, or cut the video there");
    }
    const cv::Mat colour = video_.picture();
    if (colour.empty()) return at_end();
    cv::cvtColor(colour, as_stored_, cv::COLOR_BGR2GRAY);
    turn(as_stored_, info_.turned_deg, gray_);
    return std::optional(view_of(gray_, index_++));
  }

  [[nodiscard]] Result<std::optional<GrayFrame>> at_end() const {
    if (index_ >= min_frames_) return std::optional<GrayFrame>();
    const std::string promised =
        info_.expected_frames ? " of " + std::to_string(*info_.expected_frames) : "";
    return bad_input(
        info_.name,
        "the video ends after " + std::to_string(index_) + promised + " frames",
        "copy the file from the camera again");
  }

  [[nodiscard]] std::string where() const {
    return info_.name + ": frame " + std::to_string(index_);
  }

  VideoReader video_;
  StreamInfo info_;
  int min_frames_;
  int index_ = 0;
  cv::Size first_size_;
  cv::Mat as_stored_;
  cv::Mat gray_;
};

}  // namespace

bool is_mp4(const std::filesystem::path& path) {
  const std::string kind = kind_by_extension(path);
  return kind == ".mp4" || kind == ".mov" || kind == ".m4v";
}

Result<std::unique_ptr<FrameSource>> open_video_file(const std::filesystem::path& path,
                                                     std::string name) {
  std::error_code ignored;
  if (std::filesystem::file_size(path, ignored) == 0) {
    return bad_input(
        name,
        "the file is empty",
        "copy it from the camera again; if it is empty there too, nothing was "
        "recorded");
  }
  if (!is_mp4(path)) {
    if (auto mjpg = open_mjpg_file(path, name)) return mjpg;
  }
  auto video = VideoReader::open_pictures(path, name);
  if (!video) return video.error();
  const VideoFacts& facts = video->facts();
  StreamInfo info;
  info.name = std::move(name);
  info.turned_deg = facts.turned_deg;
  info.width_px = facts.width_px;
  info.height_px = facts.height_px;
  if (facts.turned_deg % 180 != 0) std::swap(info.width_px, info.height_px);
  if (facts.rate_hz > 0.0) info.rate = FrameRate{facts.rate_hz};
  const auto promise = promise_of(path, facts);
  if (promise) info.expected_frames = promise->expected;
  const int min_frames = promise ? promise->min_frames : 1;
  return std::unique_ptr<FrameSource>(
      std::make_unique<VideoFile>(*std::move(video), std::move(info), min_frames));
}

}  // namespace marey::capture
