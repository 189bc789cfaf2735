// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "app/stage/live/stage_request.h"
#include "app/stage/run/scene_run.h"
#include "core/base/result.h"
#include "live/page/page_run.h"

namespace marey::app {

/// Targets of a scene as handles of its page.
///
/// A target in the world has one handle. A target in the frame of bodies has one, too, at
/// its first user. Dragging it moves the targets of all users, in the frame of each and
/// in proportion to their statures if the target depends on the stature. Targets without
/// users and points of bodies have no handle.
class StageTargets {
 public:
  explicit StageTargets(const SceneRun& run);

  [[nodiscard]] std::span<const StageHandle> handles() const { return handles_; }
  /// Returns the places of all handles; a held one has its last place, also while the
  /// scene is paused.
  [[nodiscard]] std::vector<live::PageTarget> places(const SceneRun& run) const;

  /// Errors (bad input): the run refuses the point. Precondition (also of the functions
  /// below): the handle exists; the run is of the same scene.
  [[nodiscard]] Status move(std::size_t handle,
                            const glm::dvec3& p_in_world,
                            SceneRun& run);
  [[nodiscard]] Status hold(std::size_t handle, SceneRun& run);
  void release(std::size_t handle, SceneRun& run);
  /// Forgets which targets are held, for a new run of the scene.
  void reset();

 private:
  struct Target {
    std::size_t target = 0;  ///< Position in Scene::targets.
    bool in_body = false;
    bool scales = false;
    std::vector<std::size_t> users{};  ///< Ascending; empty: none, in the world.
    std::optional<glm::dvec3> held_in_world{};
  };
  [[nodiscard]] glm::dvec3 place(const Target& target, const SceneRun& run) const;

  std::vector<StageHandle> handles_;
  std::vector<Target> targets_;  ///< By handle.
};

}  // namespace marey::app
