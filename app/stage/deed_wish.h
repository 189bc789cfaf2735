// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "engine/engine.h"
#include <glm/vec3.hpp>

#include "app/stage/deed_run.h"
#include "core/engine/scene.h"

namespace marey::app {

/// Layer of the clips that play under all actions; actions are above it.
inline constexpr int kIdleLayer = 0;
/// Fade of actions that state none. [s]
inline constexpr double kDeedFade_s = 0.3;

/// Requests to the engine for actions of a scene. Precondition: the action is of the
/// kind; its clip exists where `base` is asked.
[[nodiscard]] engine::ActionWish play_wish(const SceneAction& action);
[[nodiscard]] engine::ReachWish reach_wish(const SceneAction& action,
                                           const glm::dvec3& target_in_world,
                                           const engine::MotionBase& base);
[[nodiscard]] engine::ThrowWish throw_wish(const Scene& scene,
                                           const SceneAction& action,
                                           const std::optional<ThrowTrial>& trial,
                                           const std::optional<glm::dvec3>& aim);
[[nodiscard]] engine::SteerWish steer_wish(const SceneAction& action,
                                           const glm::dvec3& target_in_world);

/// Returns the target of a reach at an instant.
[[nodiscard]] engine::ReachTarget reach_target(const SceneReach& reach,
                                               const glm::dvec3& p_in_world,
                                               const glm::dvec3& velocity_m_s);

/// Returns the time of an event of a clip; nullopt: it has none of this name. [s]
[[nodiscard]] std::optional<double> event_of(const engine::MotionBase& base,
                                             const std::string& clip,
                                             const std::string& event);

}  // namespace marey::app
