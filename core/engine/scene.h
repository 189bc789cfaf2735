// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/engine/scene_action.h"
#include "core/engine/scene_body.h"
#include "core/engine/scene_figure.h"
#include "core/engine/scene_target.h"

namespace marey {

/// A scene of `marey stage` (docs/formats/scene.md): bodies, targets, a script, results.
struct Scene {
  std::string name{};
  std::uint64_t seed = 0;
  double step_hz = 60.0;
  double duration_s = 10.0;
  std::string base{};   ///< File of clips (moves.marey).
  std::string floor{};  ///< File of the floor; empty: a level floor at height 0.
  double gravity_m_s2 = 9.81;
  /// Detail budget of a step; nullopt: no limit, all bodies at level 2, full rate.
  std::optional<double> budget_units{};
  /// Cost of one body's step at levels 0 to 3; nullopt: the engine's table.
  std::optional<std::array<double, 4>> cost_units{};
  std::vector<SceneBody> bodies{};
  std::vector<SceneGroup> groups{};
  std::vector<SceneTarget> targets{};
  std::vector<SceneAction> script{};  ///< In the order of the file.
  std::vector<SceneFigure> figures{};
  SceneOutputs out{};

  [[nodiscard]] const SceneTarget* target(std::string_view id) const;
  [[nodiscard]] const SceneAction* action(std::string_view id) const;
};

/// Positions of bodies in the result of scene_bodies().
struct SceneMembers {
  std::size_t first = 0;
  std::size_t count = 0;
  /// Position of the k-th of `users` users' partner: the k-th member, or the only one.
  [[nodiscard]] std::size_t partner(std::size_t k) const {
    return count == 1 ? first : first + k;
  }
};

/// Returns all bodies: those of the file in its order, then the members of each group.
/// Generated values follow from the scene's seed and the group alone: other bodies do not
/// change them. Same input, same bytes.
/// Precondition: counts and columns >= 1.
[[nodiscard]] std::vector<SceneBody> scene_bodies(const Scene& scene);

/// Returns the number of bodies of scene_bodies().
[[nodiscard]] std::size_t body_count(const Scene& scene);

/// Returns the bodies with a name: a body, all members of a group, or one member
/// ("ID.3"); nullopt: there are none. Linear in bodies and groups.
[[nodiscard]] std::optional<SceneMembers> members_of(const Scene& scene,
                                                     std::string_view name);

}  // namespace marey
