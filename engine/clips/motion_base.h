// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "engine/sync/phases.h"

#include "core/base/result.h"
#include "core/engine/motion_clip.h"

namespace marey::engine {

/// The clips of a `moves.marey`, shared by all characters of an engine; immutable.
class MotionBase {
 public:
  /// Errors (bad input, naming the clip): fewer than two frames or another number of
  /// path entries; a number that is not finite; a rotation that is not of unit length; a
  /// rate or leg length that is not positive; contacts that do not ascend or are outside
  /// of the clip; a name that is empty or occurs twice.
  [[nodiscard]] static Result<std::shared_ptr<const MotionBase>> make(MoveSet moves);

  [[nodiscard]] const PostureLayout& layout() const { return moves_.layout; }
  [[nodiscard]] std::span<const MotionClip> clips() const { return moves_.clips; }
  [[nodiscard]] const MotionClip& clip(std::size_t i) const { return moves_.clips[i]; }
  /// Position of the clip of that name; nullopt if unknown. Logarithmic.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const;
  /// Phases of a clip, without those below 40 ms.
  [[nodiscard]] std::span<const Phase> phases(std::size_t clip) const {
    return phases_[clip];
  }
  /// True if a clip has contacts.
  [[nodiscard]] bool has_contacts(std::size_t clip) const;

 private:
  explicit MotionBase(MoveSet moves);
  MoveSet moves_;
  std::vector<std::vector<Phase>> phases_;
};

}  // namespace marey::engine
