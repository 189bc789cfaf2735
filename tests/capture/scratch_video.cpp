// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/capture/scratch_video.h"

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

namespace marey::tests {
namespace {

namespace fs = std::filesystem;

cv::Mat plain_frame(int index) {
  return {48, 64, CV_8UC3, cv::Scalar::all(brightness_of_frame(index))};
}

}  // namespace

int brightness_of_frame(int index) {
  return 20 + 8 * (index % 28);
}

void write_video(const fs::path& path, int frames) {
  const bool is_mp4 = path.extension() == ".mp4";
  const int codec = is_mp4 ? cv::VideoWriter::fourcc('m', 'p', '4', 'v')
                           : cv::VideoWriter::fourcc('M', 'J', 'P', 'G');
  cv::VideoWriter video(path.string(), cv::CAP_FFMPEG, codec, 25.0, {64, 48});
  if (!video.isOpened()) throw std::runtime_error("cannot write " + path.string());
  for (int i = 0; i < frames; ++i) video.write(plain_frame(i));
}

void write_images(const fs::path& folder, int frames) {
  fs::create_directories(folder);
  for (int i = 0; i < frames; ++i) {
    std::string name = "f";
    name.append(std::to_string(i)).append(".png");
    cv::imwrite((folder / name).string(), plain_frame(i));
  }
}

void truncate(const fs::path& path, double fraction) {
  const auto size = static_cast<double>(fs::file_size(path));
  fs::resize_file(path, static_cast<std::uintmax_t>(std::floor(size * fraction)));
}

}  // namespace marey::tests
