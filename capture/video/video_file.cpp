// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/video/video_file.h"

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "capture/video/mjpg_file.h"
#include "capture/video/mp4_duration.h"
#include "capture/video/opencv_reading.h"

namespace marey::capture {
namespace {

/// Minimum number of frames of a complete video, and the number in its header.
struct Promise {
  int expected = 0;
  int least = 0;
};

std::optional<Promise> promise_of(const std::filesystem::path& path,
                                  const cv::VideoCapture& video,
                                  double rate_hz) {
  const double count = video.get(cv::CAP_PROP_FRAME_COUNT);
  if (!(count >= 1.0) || count > 1e9) return std::nullopt;
  const int stored = static_cast<int>(std::lround(count));
  if (!is_mp4(path)) {
    // Here FFmpeg multiplies a rounded duration by a rounded rate.
    return Promise{stored, stored - std::max(2, stored / 50)};
  }
  const std::optional<double> duration_s = mp4_duration_s(path);
  if (!duration_s || rate_hz <= 0.0) return Promise{stored, stored};
  // An edit list hides some of the stored frames; only the duration considers it.
  const int shown = static_cast<int>(std::lround(*duration_s * rate_hz));
  if (shown >= stored || shown < 1) return Promise{stored, stored};
  return Promise{shown, shown - 1};
}

class VideoFile final : public FrameSource {
 public:
  VideoFile(const cv::VideoCapture& video, StreamInfo info, int min_frames)
      : video_(video), info_(std::move(info)), min_frames_(min_frames) {}

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
    if (!video_.read(colour_)) return at_end();
    if (colour_.cols != info_.width_px || colour_.rows != info_.height_px) {
      return bad_input(where(),
                       "the picture changes its size to " + size_text(colour_) +
                           ", the video began with " +
                           size_text(info_.width_px, info_.height_px),
                       "record with one size, or cut the video there");
    }
    to_gray(colour_, gray_);
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

  cv::VideoCapture video_;  // A handle: copies share one decoder.
  StreamInfo info_;
  int min_frames_;
  int index_ = 0;
  cv::Mat colour_;
  cv::Mat gray_;
};

}  // namespace

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
  auto video = open_capture(path, name);
  if (!video) return video.error();
  StreamInfo info;
  info.name = std::move(name);
  info.width_px = static_cast<int>(video->get(cv::CAP_PROP_FRAME_WIDTH));
  info.height_px = static_cast<int>(video->get(cv::CAP_PROP_FRAME_HEIGHT));
  const auto turned_deg = static_cast<int>(video->get(cv::CAP_PROP_ORIENTATION_META));
  info.turned_deg = (turned_deg % 360 + 360) % 360;
  const double rate_hz = video->get(cv::CAP_PROP_FPS);
  if (std::isfinite(rate_hz) && rate_hz > 0.0) info.rate = FrameRate{rate_hz};
  const auto promise = promise_of(path, *video, info.rate ? rate_hz : 0.0);
  if (promise) info.expected_frames = promise->expected;
  const int min_frames = promise ? promise->least : 1;
  return std::unique_ptr<FrameSource>(
      std::make_unique<VideoFile>(*video, std::move(info), min_frames));
}

}  // namespace marey::capture
