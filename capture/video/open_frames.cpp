// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/video/open_frames.h"

#include <system_error>
#include <utility>

#include "capture/video/image_folder.h"
#include "capture/video/video_file.h"
#include "core/base/name_pattern.h"

namespace marey::capture {

Result<RecordingKind> recording_kind(const std::filesystem::path& path,
                                     const std::string& name) {
  std::error_code ignored;
  if (is_name_pattern(path) &&
      std::filesystem::is_directory(path.parent_path(), ignored)) {
    return RecordingKind::kImageFolder;
  }
  const auto status = std::filesystem::status(path, ignored);
  if (!std::filesystem::exists(status)) {
    return bad_input(
        name, "the video or folder does not exist", "check the name and the folder");
  }
  return std::filesystem::is_directory(status) ? RecordingKind::kImageFolder
                                               : RecordingKind::kVideoFile;
}

Result<std::unique_ptr<FrameSource>> open_frames(const std::filesystem::path& path,
                                                 std::string name) {
  if (name.empty()) name = path.string();
  const auto kind = recording_kind(path, name);
  if (!kind) return kind.error();
  return *kind == RecordingKind::kImageFolder ? open_image_folder(path, std::move(name))
                                              : open_video_file(path, std::move(name));
}

}  // namespace marey::capture
