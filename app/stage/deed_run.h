// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "engine/engine.h"
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/base/result.h"
#include "core/engine/scene.h"
#include "core/engine/throw_trials.h"
#include "retarget/adapt/adapter.h"

namespace marey::app {

/// One action of the script on one body; of a list of trials one throw.
struct DeedRun {
  enum class Phase { kWaiting, kRunning, kOver };
  std::size_t action = 0;  ///< Position in Scene::script.
  std::size_t body = 0;
  double due_s = 0.0;                   ///< Earliest start.
  std::optional<std::size_t> after{};   ///< Position of the run that it waits for.
  std::optional<std::size_t> use{};     ///< Position of its target in RunTargets::uses().
  std::optional<std::size_t> trial{};   ///< Position in the order of trials.
  std::optional<ThrowTrial> changes{};  ///< The trial's parameter.

  Phase phase = Phase::kWaiting;
  double started_s = 0.0;
  double end_s = std::numeric_limits<double>::infinity();
  std::optional<engine::ActionId> played{};
  std::optional<retarget::Adapter::Handle> handle{};  ///< Of a constraint.
  bool is_first_step = true;
  std::optional<glm::dvec3> last_target{};
  glm::dvec3 follows_at{0.0};  ///< Of `follow`: its target at a bounded speed.
  bool has_arrived = false;    ///< Of `steer` with `keeps`.
  bool is_thrown = false;      ///< The throw is in the record.
  std::size_t passed = 0;      ///< Events that are in the record.
};

/// Returns the id of the constraint of an action: a `constrain` or a `follow`.
[[nodiscard]] std::string deed_constraint_id(std::size_t action);
/// Returns the constraint of an action, which acts when it is started; nullopt: the
/// action has none.
[[nodiscard]] std::optional<Constraint> deed_constraint(const SceneAction& action,
                                                        std::size_t position);

/// Checks an action before the scene runs. Errors (bad input, with the action): an
/// unknown clip, with the nearest name; an event that the clip does not have; a value
/// that the engine refuses; a jump, which scenes do not play yet.
[[nodiscard]] Status check_deed(const SceneAction& action,
                                engine::CharacterId body,
                                engine::Engine& engine);

/// Begins an action with the next step. Errors: those of the engine.
[[nodiscard]] Status start_deed(const Scene& scene,
                                DeedRun& run,
                                const glm::dvec3& target_in_world,
                                engine::Engine& engine);

/// Moves the target of an action that runs, before the step of its body.
void aim_deed(const Scene& scene,
              DeedRun& run,
              const glm::dvec3& target_in_world,
              engine::Engine& engine);

/// Ends an action: clips fade out, constraints too, loads are put down.
void stop_deed(const Scene& scene, DeedRun& run, engine::Engine& engine);

/// Returns the clip of an action; nullptr: it has none.
[[nodiscard]] const std::string* clip_of(const SceneAction& action);

}  // namespace marey::app
