// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/result.h"
#include "core/time.h"

namespace marey::capture {

/// A view of one grey image, 8 bits a pixel, rows from the top. It owns nothing: the
/// pixels belong to whoever made it.
struct GrayFrame {
  const std::uint8_t* pixels = nullptr;
  int width_px = 0;
  int height_px = 0;
  int stride = 0;  ///< Bytes from one row to the next, >= width_px.
  int index = 0;   ///< Frames before this one in its stream.
  /// It is damaged in the file and could not be decoded: nothing is to be seen in it.
  bool damaged = false;
};

/// What a stream says of itself before its first frame.
struct StreamInfo {
  std::string name;  ///< As messages should name it.
  int width_px = 0;
  int height_px = 0;
  std::optional<FrameRate> rate;       ///< nullopt when the stream does not know.
  std::optional<int> expected_frames;  ///< nullopt when only the end will tell.
  /// By how much its rotation mark has turned every frame, clockwise; its size is after
  /// that. [degrees] 0, 90, 180 or 270.
  int turned_deg = 0;
};

/// Frames in the order of their exposure.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  [[nodiscard]] virtual const StreamInfo& info() const = 0;

  /// The next frame, its pixels valid until the next call or the end of this object;
  /// nullopt at a clean end. Every frame is info().width_px by info().height_px, and
  /// `index` counts 0, 1, 2... After an error or the end, do not call again.
  [[nodiscard]] virtual Result<std::optional<GrayFrame>> next() = 0;

 protected:
  FrameSource() = default;
  FrameSource(const FrameSource&) = default;
  FrameSource& operator=(const FrameSource&) = default;
};

enum class RecordingKind { kVideoFile, kImageFolder };

/// What is at `path`: a folder means images, as does a pattern of their names. kBadInput
/// when there is nothing. Messages call it `name`.
[[nodiscard]] Result<RecordingKind> recording_kind(const std::filesystem::path& path,
                                                   const std::string& name);

/// The frames of a video file, or of a folder of images: whichever `path` is. Messages
/// call it `name`, or its path when that is empty. Errors as recording_kind(),
/// open_video_file() and open_image_folder() say.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_frames(
    const std::filesystem::path& path, std::string name = {});

}  // namespace marey::capture
