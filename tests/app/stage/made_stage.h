// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "app/stage/run/scene_run.h"

namespace marey::app::testing {

/// A base of written clips: "idle", one standing posture, which loops; "wave", that
/// posture for one second while the right arm rises, with the event "impact" after half a
/// second.
[[nodiscard]] std::shared_ptr<const engine::MotionBase> made_stage_base();

/// Returns the input of a run: the scene of the text, after the keys format, name,
/// duration_s (3 s) and base, and its bodies. Precondition: the scene is good.
[[nodiscard]] SceneRunInput made_stage_input(const std::string& text);

/// Returns the message of the error with which a scene is refused; empty: it is not.
[[nodiscard]] std::string refusal_of(const std::string& text);

/// Runs a scene to its end.
[[nodiscard]] SceneRun played(SceneRunInput input);

}  // namespace marey::app::testing
