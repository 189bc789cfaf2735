// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/video/image_folder.h"

#include <algorithm>
#include <optional>
#include <system_error>
#include <utility>

#include <opencv2/core.hpp>

#include "capture/video/read_image.h"
#include "core/base/extension.h"
#include "core/base/name_pattern.h"

namespace marey::capture {
namespace {

namespace fs = std::filesystem;

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Removes the leading digits of `text`, and returns them without leading zeros.
std::string_view take_number(std::string_view& text) {
  const auto end = static_cast<std::size_t>(
      std::find_if_not(text.begin(), text.end(), is_digit) - text.begin());
  std::string_view digits = text.substr(0, end);
  text.remove_prefix(end);
  digits.remove_prefix(std::min(digits.find_first_not_of('0'), digits.size()));
  return digits;
}

/// Returns a negative number, zero or a positive number if `a` is before, equal to or
/// after `b`.
int natural_compare(std::string_view a, std::string_view b) {
  while (!a.empty() && !b.empty()) {
    if (is_digit(a.front()) && is_digit(b.front())) {
      const std::string_view number_a = take_number(a);
      const std::string_view number_b = take_number(b);
      if (number_a.size() != number_b.size()) {
        return number_a.size() < number_b.size() ? -1 : 1;
      }
      if (const int order = number_a.compare(number_b); order != 0) return order;
    } else {
      if (a.front() != b.front()) return a.front() < b.front() ? -1 : 1;
      a.remove_prefix(1);
      b.remove_prefix(1);
    }
  }
  return static_cast<int>(!a.empty()) - static_cast<int>(!b.empty());
}

bool is_image(const fs::path& path) {
  const std::string kind = kind_by_extension(path);
  return kind == ".png" || kind == ".jpg" || kind == ".jpeg";
}

class ImageFolder final : public FrameSource {
 public:
  ImageFolder(std::vector<fs::path> images, cv::Mat first, std::string name)
      : images_(std::move(images)), gray_(std::move(first)) {
    info_.name = std::move(name);
    info_.width_px = gray_.cols;
    info_.height_px = gray_.rows;
    info_.expected_frames = static_cast<int>(images_.size());
  }

  [[nodiscard]] const StreamInfo& info() const override { return info_; }

  Result<std::optional<GrayFrame>> next() override {
    const auto place = static_cast<std::size_t>(index_);
    if (place >= images_.size()) return std::optional<GrayFrame>();
    if (index_ > 0) {  // The first image was read on opening.
      const std::string where = info_.name + "/" + images_[place].filename().string();
      auto image = read_image(images_[place], ImageColours::kGrey, where);
      if (!image) return image.error();
      gray_ = std::move(*image);
      if (gray_.cols != info_.width_px || gray_.rows != info_.height_px) {
        return bad_input(where,
                         "the image is " + size_text(gray_.size()) +
                             ", the first one is " +
                             size_text(info_.width_px, info_.height_px),
                         "keep only images of one camera and size in the folder");
      }
    }
    return std::optional(view_of(gray_, index_++));
  }

 private:
  std::vector<fs::path> images_;
  StreamInfo info_;
  int index_ = 0;
  cv::Mat gray_;
};

}  // namespace

bool natural_less(std::string_view a, std::string_view b) {
  const int order = natural_compare(a, b);
  return order != 0 ? order < 0 : a < b;
}

Result<std::vector<fs::path>> list_images(const fs::path& folder,
                                          const std::string& name) {
  const bool some = is_name_pattern(folder);
  std::vector<fs::path> images;
  std::error_code failed;
  for (fs::directory_iterator entry(some ? folder.parent_path() : folder, failed), end;
       !failed && entry != end;
       entry.increment(failed)) {
    const fs::path& path = entry->path();
    if (some && !fits_pattern(path.filename().string(), folder.filename().string())) {
      continue;
    }
    if (is_image(path)) images.push_back(path);
  }
  if (failed) {
    return bad_input(name,
                     "the folder cannot be read: " + failed.message(),
                     "check that you may read it");
  }
  if (images.empty()) {
    return bad_input(name,
                     "the folder has no .png or .jpg images",
                     "name a video file or a folder with the frames as images");
  }
  std::sort(images.begin(), images.end(), [](const fs::path& a, const fs::path& b) {
    return natural_less(a.filename().string(), b.filename().string());
  });
  return images;
}

Result<std::unique_ptr<FrameSource>> open_image_folder(const fs::path& folder,
                                                       std::string name) {
  auto images = list_images(folder, name);
  if (!images) return images.error();
  const fs::path& path = images->front();
  auto first =
      read_image(path, ImageColours::kGrey, name + "/" + path.filename().string());
  if (!first) return first.error();
  return std::unique_ptr<FrameSource>(std::make_unique<ImageFolder>(
      std::move(*images), std::move(*first), std::move(name)));
}

}  // namespace marey::capture
