// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "engine/engine.h"

#include "core/skeleton.h"

namespace marey::engine {

/// A base of written clips of an average adult: "walk" and "stroll" (slower), which loop;
/// "steps", the walk once; "still", one posture of the walk with the right arm turned, for
/// two seconds, with the event "arrive" after one second; "throw", that posture while the
/// right arm throws, with the event "release" after one second.
[[nodiscard]] std::shared_ptr<const MotionBase> made_base();

/// The body of these clips.
[[nodiscard]] const Skeleton& made_skeleton();

/// A character with that body or another one.
[[nodiscard]] CharacterSpec made_character(const Skeleton& skeleton = made_skeleton());

}  // namespace marey::engine
