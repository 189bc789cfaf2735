// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "engine/clips/motion_base.h"
#include "engine/step/blend_player.h"

#include "core/base/result.h"
#include "core/constraint.h"
#include "retarget/adapt/adapter.h"

namespace marey::engine {

/// Constraints of clips that act while their clip plays: the activation that the clip
/// gives, times the weight of the action. Places of the clip move with the root: they are
/// where the root of the clip has them, on this body, unless the id of the constraint
/// begins with "world/": then they stay in the world. Supports are left out, since the
/// engine holds the feet.
class ClipConstraints {
 public:
  /// Returns the constraints of the named clips for the adapter, with the ids
  /// "clip/constraint". They do not act yet. Errors (bad input): an unknown clip.
  [[nodiscard]] static Result<std::vector<Constraint>> reserve(
      const MotionBase& base, std::span<const std::string> clips);

  /// Finds the constraints of reserve() in an adapter, which must outlive it.
  void attach(const MotionBase& base,
              std::span<const std::string> clips,
              retarget::Adapter& adapter);

  /// Moves the targets and sets the shares. Allocates nothing.
  void step(double time_s, double leg_length_m, const BlendPlayer& blend);

  [[nodiscard]] std::size_t size() const { return entries_.size(); }

 private:
  struct Entry {
    std::size_t clip = 0;
    Constraint constraint;  ///< As in the clip.
    bool stays_in_world = false;
    retarget::Adapter::Handle handle;
  };
  static void place(const Entry& entry,
                    const MotionClip& clip,
                    double source_s,
                    double leg_length_m,
                    const RootPlace& root,
                    retarget::Adapter::Handle handle);
  std::vector<Entry> entries_;
};

}  // namespace marey::engine
