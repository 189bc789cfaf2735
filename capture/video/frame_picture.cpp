// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/video/frame_picture.h"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <utility>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <turbojpeg.h>

#include "capture/video/frame_source.h"
#include "capture/video/image_folder.h"
#include "capture/video/open_frames.h"
#include "capture/video/read_image.h"
#include "capture/video/video_reader.h"
#include "core/base/assert.h"

namespace marey::capture {
namespace {

Error no_such_frame(const std::string& name, int frame, std::size_t has) {
  return bad_input(name,
                   "there is no frame " + std::to_string(frame) + ", it has " +
                       std::to_string(has) + ", counted from 0",
                   "choose an earlier frame");
}

struct DestroyEncoder {
  void operator()(void* handle) const { tjDestroy(handle); }
};

std::vector<std::byte> jpeg_of(const cv::Mat& bgr, int quality) {
  const std::unique_ptr<void, DestroyEncoder> encoder(tjInitCompress());
  std::vector<std::byte> jpeg(tjBufSize(bgr.cols, bgr.rows, TJSAMP_420));
  auto* bytes = reinterpret_cast<unsigned char*>(jpeg.data());
  unsigned long size = jpeg.size();
  const int failed = tjCompress2(encoder.get(),
                                 bgr.data,
                                 bgr.cols,
                                 static_cast<int>(bgr.step[0]),
                                 bgr.rows,
                                 TJPF_BGR,
                                 &bytes,
                                 &size,
                                 TJSAMP_420,
                                 quality,
                                 TJFLAG_NOREALLOC | TJFLAG_ACCURATEDCT);
  MAREY_ASSERT(failed == 0);  // Fails only without memory, or beyond 65535 pixels.
  jpeg.resize(size);
  return jpeg;
}

FramePicture encode(const cv::Mat& image, int frame, const PictureOptions& options) {
  FramePicture picture;
  picture.frame = frame;
  picture.scale = std::min(1.0, static_cast<double>(options.max_width_px) / image.cols);
  cv::Mat small;
  cv::resize(image, small, {}, picture.scale, picture.scale, cv::INTER_AREA);
  picture.width_px = small.cols;
  picture.height_px = small.rows;
  picture.jpeg = jpeg_of(small, options.jpeg_quality);
  return picture;
}

using Pictures = std::map<int, FramePicture>;

/// Precondition: `frames` ascending, each once.
Result<Pictures> from_video(const std::filesystem::path& path,
                            std::span<const int> frames,
                            const PictureOptions& options,
                            const std::string& name) {
  auto video = VideoReader::open_pictures(path, name);
  if (!video) return video.error();
  const VideoFacts& facts = video->facts();
  Pictures pictures;
  cv::Mat image;
  int next = 0;
  for (const int frame : frames) {
    // grab() decodes without a conversion to colour: sufficient for skipped frames.
    for (; next <= frame; ++next) {
      if (!video->grab())
        return no_such_frame(name, frame, static_cast<std::size_t>(next));
    }
    const cv::Size size = video->grabbed_size();
    const bool too_small = size.width < facts.width_px || size.height < facts.height_px;
    const cv::Mat stored = too_small ? cv::Mat() : video->picture();
    if (stored.empty()) {
      return no_such_frame(name, frame, static_cast<std::size_t>(frame));
    }
    turn(stored, facts.turned_deg, image);
    pictures[frame] = encode(image, frame, options);
  }
  return pictures;
}

Result<Pictures> from_folder(const std::filesystem::path& path,
                             std::span<const int> frames,
                             const PictureOptions& options,
                             const std::string& name) {
  const auto files = list_images(path, name);
  if (!files) return files.error();
  Pictures pictures;
  for (const int frame : frames) {
    const auto place = static_cast<std::size_t>(frame);
    if (place >= files->size()) return no_such_frame(name, frame, files->size());
    const auto& file = (*files)[place];
    const auto image =
        read_image(file, ImageColours::kBgr, name + "/" + file.filename().string());
    if (!image) return image.error();
    pictures[frame] = encode(*image, frame, options);
  }
  return pictures;
}

}  // namespace

Result<std::vector<FramePicture>> read_pictures(const std::filesystem::path& path,
                                                std::span<const int> frames,
                                                const PictureOptions& options,
                                                const std::string& name) {
  MAREY_ASSERT(options.max_width_px >= 1);
  MAREY_ASSERT(options.jpeg_quality >= 1 && options.jpeg_quality <= 100);
  std::vector<int> wanted(frames.begin(), frames.end());
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  MAREY_ASSERT(wanted.empty() || wanted.front() >= 0);
  const std::string called = name.empty() ? path.string() : name;
  const auto kind = recording_kind(path, called);
  if (!kind) return kind.error();
  try {
    const auto pictures = *kind == RecordingKind::kImageFolder
                              ? from_folder(path, wanted, options, called)
                              : from_video(path, wanted, options, called);
    if (!pictures) return pictures.error();
    std::vector<FramePicture> out;
    for (const int frame : frames) out.push_back(pictures->at(frame));
    return out;
  } catch (const cv::Exception& e) {
    return bad_input(called, e.err, "convert the video to H.264 in MP4 and try again");
  }
}

Result<std::vector<std::byte>> jpeg_of_frame(const std::filesystem::path& path,
                                             int frame,
                                             const PictureOptions& options) {
  const std::array<int, 1> frames{frame};
  auto pictures = read_pictures(path, frames, options);
  if (!pictures) return pictures.error();
  return std::move(pictures->front().jpeg);
}

}  // namespace marey::capture
