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

  [[nodiscard]] const PostureLayout& layout() const { return shared_->moves.layout; }
  /// The clips of the file, without own ones.
  [[nodiscard]] std::span<const MotionClip> clips() const { return shared_->moves.clips; }
  [[nodiscard]] const MotionClip& clip(std::size_t i) const {
    return i < clips().size() ? shared_->moves.clips[i] : own_[i - clips().size()]->clip;
  }
  /// Position of the clip of that name; nullopt if unknown. Logarithmic.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const;
  /// Phases of a clip, without those below 40 ms.
  [[nodiscard]] std::span<const Phase> phases(std::size_t clip) const {
    return clip < clips().size() ? std::span<const Phase>(shared_->phases[clip])
                                 : own_[clip - clips().size()]->phases;
  }
  /// Returns a base with the same clips, and one more for a single character: at
  /// clips().size() + slot, in place of an earlier one of that slot. The clips of the
  /// file are shared. Precondition: slot <= number of own clips.
  [[nodiscard]] std::shared_ptr<const MotionBase> with_own(std::size_t slot,
                                                           MotionClip clip) const;
  [[nodiscard]] std::size_t own_count() const { return own_.size(); }
  /// True if a clip has contacts.
  [[nodiscard]] bool has_contacts(std::size_t clip) const;

 private:
  struct Shared {
    MoveSet moves;
    std::vector<std::vector<Phase>> phases;
  };
  struct Own {
    MotionClip clip;
    std::vector<Phase> phases;
  };
  explicit MotionBase(MoveSet moves);
  MotionBase(const MotionBase&) = default;
  std::shared_ptr<const Shared> shared_;
  std::vector<std::shared_ptr<const Own>> own_;
};

}  // namespace marey::engine
