// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

#include "core/base/result.h"
#include "core/base/time.h"

namespace marey::recordings {

struct MjpgVideoOptions {
  int width_px = 0;
  int height_px = 0;
  FrameRate rate;  ///< Nominal rate for players.
  /// Maximum interval between flushes while frames arrive.
  std::chrono::milliseconds flush_every{400};
};

/// Writes a Matroska video of JPEG frames, each stored byte for byte. Players open it
/// even if writing was interrupted. Not thread-safe.
class MjpgVideo {
 public:
  /// Creates the file; replaces an existing one. Errors (kDevice): the file cannot be
  /// created, and none is left. Preconditions: positive size and rate.
  [[nodiscard]] static Result<MjpgVideo> create(const std::filesystem::path& path,
                                                const MjpgVideoOptions& options);
  MjpgVideo(MjpgVideo&&) noexcept;
  MjpgVideo& operator=(MjpgVideo&&) noexcept;
  ~MjpgVideo();

  /// Appends a frame with display time `time`; players receive increasing times in
  /// milliseconds. Errors (kDevice): the disk is full or failed.
  [[nodiscard]] Status write(std::span<const std::byte> jpeg, Timestamp time);
  /// Writes all buffered data to the file now, for pauses without new frames. Costs
  /// little if there is no buffered data. Errors: those of write().
  [[nodiscard]] Status flush();
  /// Writes the index that lets players seek. Errors: those of write(). No call of
  /// write() may follow.
  [[nodiscard]] Status finish();

 private:
  struct Impl;
  explicit MjpgVideo(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace marey::recordings
