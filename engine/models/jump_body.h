// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dynamics/jumps/jump_plan.h"
#include "dynamics/jumps/jump_reference.h"
#include "dynamics/jumps/jump_wish.h"

#include "core/base/result.h"
#include "core/character.h"
#include "core/engine/motion_clip.h"
#include "retarget/body/body_map.h"

namespace marey::engine {

/// A jump of a clip on one body, prepared for changes of its apex, its time in the air or
/// its landing (dynamics::plan_jump()). The frame of all places: the hips of the clip's
/// first frame stand above the origin and face +Z.
class JumpBody {
 public:
  /// Poses the clip on the body and finds its jumps. Some milliseconds; allocates.
  /// Errors (bad input, naming the clip): it loops; a body without masses; no jump of
  /// this number (from 0); a captured push that does not lead to its take-off.
  /// `character` and `map` must outlive it.
  [[nodiscard]] static Result<std::shared_ptr<const JumpBody>> make(
      const MotionClip& clip,
      const PostureLayout& layout,
      const Character& character,
      const retarget::BodyMap& map,
      int jump);

  [[nodiscard]] const dynamics::Jump& captured() const { return reference_->jump(); }
  /// Plans changes. Errors: dynamics::plan_jump()'s. Some ten microseconds.
  [[nodiscard]] Result<dynamics::JumpPlan> plan(const dynamics::JumpWish& wish,
                                                const dynamics::JumpTraits& traits) const;
  /// Makes the clip of a plan: the captured postures at their new times, the root moved
  /// so that the centre of mass of this body follows the plan. Contacts and events are at
  /// their new times. Linear in frames, some microseconds each; allocates.
  [[nodiscard]] MotionClip planned_clip(const MotionClip& clip,
                                        const dynamics::JumpPlan& plan) const;

 private:
  JumpBody(const PostureLayout& layout,
           const Character& character,
           const retarget::BodyMap& map)
      : layout_(layout), character_(&character), map_(&map) {}

  PostureLayout layout_;
  const Character* character_;
  const retarget::BodyMap* map_;
  std::unique_ptr<dynamics::JumpReference> reference_;
};

}  // namespace marey::engine
