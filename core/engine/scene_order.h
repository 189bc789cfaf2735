// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/engine/scene.h"

namespace marey {

/// Time in which an action can be active. [s]
struct ActionTime {
  double start_s = 0.0;         ///< Earliest start.
  double latest_start_s = 0.0;  ///< Equal to start_s if the file determines it.
  double end_s = 0.0;           ///< Latest end, with its fade; at most the scene's end.
};

/// Time that an action without fade_out_s takes to fade out, for end_s. [s]
inline constexpr double kAssumedFade_s = 0.3;

/// Returns the times of all actions of the script, as far as the file determines them:
/// by for_s, by stops, and by the ends of actions that they wait for. Ends of clips are
/// unknown: such an action may last to the scene's end. Precondition: no action waits
/// for itself. Linear in the script times its stops.
[[nodiscard]] std::vector<ActionTime> action_times(const Scene& scene);

/// A body that in each step of a time is solved after another one, because its target is
/// a point of that body in the same step.
struct SceneDependency {
  std::size_t body = 0;  ///< Position in scene_bodies().
  std::size_t on = 0;
  std::size_t action = 0;  ///< Position in the script.
  double start_s = 0.0;
  double end_s = 0.0;
};

/// Returns the dependencies of all bodies, in the order of the script. An action whose
/// target or bodies do not exist, or cannot be paired, has none.
[[nodiscard]] std::vector<SceneDependency> scene_dependencies(const Scene& scene);

/// Bodies that depend on each other at a time: each on the next one, the last one on the
/// first.
struct DependencyCycle {
  double time_s = 0.0;
  std::vector<SceneDependency> links{};
};

/// Returns the earliest cycle; nullopt without a cycle. Linear in
/// dependencies if they have no cycle when all are active; else times the number of
/// different starts.
[[nodiscard]] std::optional<DependencyCycle> find_cycle(
    const std::vector<SceneDependency>& dependencies, std::size_t bodies);

/// Computes the order in which the bodies of a step are solved at a time: `rounds` holds
/// a number for each body. A body depends only on bodies of lower rounds; bodies of one
/// round do not depend on each other. Cost: dependencies times the rounds, of which
/// scenes have two or three. Allocates only where `rounds` grows. Precondition: no cycle
/// at that time.
void solve_rounds(const std::vector<SceneDependency>& dependencies,
                  double time_s,
                  std::size_t bodies,
                  std::vector<std::size_t>& rounds);

}  // namespace marey
