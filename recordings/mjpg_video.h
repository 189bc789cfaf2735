// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

#include "core/result.h"
#include "core/time.h"

namespace marey::recordings {

struct MjpgVideoOptions {
  int width_px = 0;
  int height_px = 0;
  FrameRate rate;  ///< What players should be told.
  /// While frames come, they reach the file at least this often.
  std::chrono::milliseconds flush_every{400};
};

/// A Matroska video of JPEG pictures, each kept byte for byte. Every player opens it,
/// also when it was cut off while it was written. One thread at a time.
class MjpgVideo {
 public:
  /// Writes over a file that is there. Errors (kDevice): the file cannot be made; none is
  /// left then. Preconditions: positive size and rate.
  [[nodiscard]] static Result<MjpgVideo> create(const std::filesystem::path& path,
                                                const MjpgVideoOptions& options);
  MjpgVideo(MjpgVideo&&) noexcept;
  MjpgVideo& operator=(MjpgVideo&&) noexcept;
  ~MjpgVideo();

  /// Appends a frame, to be shown at `time`; players get it in milliseconds, growing. Errors (kDevice): the disk is full or failed.
  [[nodiscard]] Status write(std::span<const std::byte> jpeg, Timestamp time);
  /// Puts all that was written into the file now: for when no more frames come that would
  /// take it along. Costs little when there is nothing. Errors as write().
  [[nodiscard]] Status flush();
  /// Writes the index that lets players jump. Errors as write(). Not to be written to
  /// afterwards.
  [[nodiscard]] Status finish();

 private:
  struct Impl;
  explicit MjpgVideo(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace marey::recordings
