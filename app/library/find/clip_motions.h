// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <list>
#include <memory>
#include <string>
#include <utility>

#include "core/base/result.h"
#include "core/library/clip_record.h"
#include "core/library/library_motion.h"

namespace marey::app {

/// Treatment of objects that are links to places outside the library.
enum class OuterLinks { kFollow, kRefuse };

/// Reads motions of clips, and keeps the objects that were read last: clips of one source
/// share an object.
class ClipMotions {
 public:
  /// A program that serves motions to others refuses links: the library may be of
  /// unknown origin.
  ClipMotions(std::filesystem::path library, OuterLinks links)
      : library_(std::move(library)), links_(links) {}

  /// Returns the frames of a clip. Errors (kBadInput): the record names no object (64
  /// hexadecimal digits), or a link that is refused; the object is missing or damaged, or
  /// does not have the clip's frames. Linear in frames times joints.
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

  /// The command that makes an object again.
  [[nodiscard]] std::string next_step() const;

  std::filesystem::path library_;
  OuterLinks links_ = OuterLinks::kRefuse;
  std::list<Kept> kept_;  ///< Newest first.
};

}  // namespace marey::app
