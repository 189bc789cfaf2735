// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "engine/engine.h"

#include "app/stage/run/stage_record.h"
#include "core/base/result.h"
#include "core/constraint.h"
#include "core/engine/scene.h"
#include "core/engine/throw_trials.h"

namespace marey::app {

/// Returns the clip of an action; empty: it plays none.
[[nodiscard]] const std::string& clip_of(const SceneAction& action);

/// Returns the place of an action in messages: `scene "NAME", line 12 ("kick.1")`.
[[nodiscard]] std::string place_of(const Scene& scene, const SceneAction& action);

/// Returns the request of a clip with the values that all actions have in common.
[[nodiscard]] engine::ActionWish action_wish(const SceneAction& action);

/// Requests of the models, without their targets, which change with the step.
[[nodiscard]] engine::ActionWish play_wish(const SceneAction& action,
                                           const ScenePlay& play);
/// `event_s`: time of the arrival in the clip.
[[nodiscard]] engine::ReachWish reach_wish(const SceneAction& action,
                                           const SceneReach& reach,
                                           double event_s);
[[nodiscard]] engine::SteerWish steer_wish(const SceneAction& action,
                                           const SceneSteer& steer);
/// `trial`: a parameter that replaces that of the script; nullptr: none.
[[nodiscard]] engine::ThrowWish throw_wish(const SceneAction& action,
                                           const SceneThrow& deed,
                                           const ThrowTrial* trial,
                                           double gravity_m_s2);

/// Without the landing on a target, which the caller sets.
[[nodiscard]] engine::JumpWish jump_wish(const SceneAction& action,
                                         const SceneJump& jump);

/// Returns the id of the constraint by which the script's k-th action acts.
[[nodiscard]] std::string constraint_id(std::size_t action);

/// Returns the constraint of an action that never starts by itself; nullopt: the action
/// acts by none.
[[nodiscard]] std::optional<Constraint> constraint_of(const SceneAction& action,
                                                      std::size_t k);

/// Returns the name of the load that the script's k-th action carries.
[[nodiscard]] std::string load_name(std::size_t action);

/// Checks an action on one of its bodies. Errors (bad input): an unknown clip, with the
/// nearest name; an endless play of a clip that is no loop; a segment that the body does
/// not have; an event that the clip does not have; a deed that this version does not
/// play.
[[nodiscard]] Status check_action(const Scene& scene,
                                  const SceneAction& action,
                                  const StageBody& body,
                                  const engine::MotionBase& base);

/// Returns the time of an event in a clip; nullopt: it has no such event.
[[nodiscard]] std::optional<double> event_s(const MotionClip& clip,
                                            std::string_view event);

}  // namespace marey::app
