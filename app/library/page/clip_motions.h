// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <list>
#include <memory>
#include <string>

#include "core/base/result.h"
#include "core/library/clip_record.h"
#include "core/library/library_motion.h"

namespace marey::app {

/// Reads motions of clips, and keeps the objects that were read last: clips of one source
/// share an object.
class ClipMotions {
 public:
  explicit ClipMotions(std::filesystem::path library) : library_(std::move(library)) {}

  /// Returns the frames of a clip. Errors (kBadInput): the index names no object of this
  /// library, or a link to another place; the object is missing or damaged, or does not
  /// contain the frames. Linear in frames times joints.
  [[nodiscard]] Result<LibraryMotion> read(const ClipRecord& clip);

  /// Frames of all kept objects together, unless a single one has more.
  static constexpr std::size_t kMaxKeptFrames = 100'000;

 private:
  struct Kept {
    std::string key;
    std::shared_ptr<const LibraryMotion> object;
  };
  [[nodiscard]] Result<std::shared_ptr<const LibraryMotion>> object(
      const std::string& key);

  std::filesystem::path library_;
  std::list<Kept> kept_;  ///< Newest first.
};

}  // namespace marey::app
