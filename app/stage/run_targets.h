// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/engine.h"
#include <glm/vec3.hpp>

#include "app/stage/body_point.h"
#include "app/stage/stage_record.h"
#include "core/base/result.h"

namespace marey::app {

/// A target for one body that uses it.
struct TargetUse {
  std::size_t target = 0;  ///< Position in Scene::targets.
  std::size_t body = 0;    ///< The user.
  /// For a point of another body: that body, and the point.
  std::optional<std::size_t> partner{};
  PointOfBody point{};
  bool last_step = false;  ///< The point is that of the step before.
  bool by_action = false;  ///< An action uses it, not only a figure.
  glm::dvec3 p_in_world{0.0};
};

/// Positions of all targets of a scene for the bodies that use them.
class RunTargets {
 public:
  /// Errors (bad input): a point of a segment that the body does not have.
  [[nodiscard]] static Result<RunTargets> make(const Scene& scene,
                                               std::span<const StageBody> bodies);

  [[nodiscard]] std::span<const TargetUse> uses() const { return uses_; }
  /// Position of a use; nullopt: neither action nor figure of this body uses the target.
  [[nodiscard]] std::optional<std::size_t> find(std::size_t target,
                                                std::size_t body) const;

  /// Computes the targets at the begin of a step: paths, and points of the step before.
  void begin_step(const Scene& scene,
                  std::span<const StageBody> bodies,
                  const engine::Engine& engine,
                  double time_s);
  /// Computes the targets of one body that are points of bodies of the same step, which
  /// have been solved.
  void solve_before(std::size_t body, const engine::Engine& engine);
  /// Computes the points of bodies for those users that did not wait for them.
  void end_step(const engine::Engine& engine);

  /// Holds a target for one user or for all; nullopt: back to its path.
  void hold(std::size_t target,
            const std::optional<glm::dvec3>& p_in_world,
            std::optional<std::size_t> user);

 private:
  [[nodiscard]] static Result<TargetUse> make_use(const Scene& scene,
                                                  std::span<const StageBody> bodies,
                                                  std::size_t target,
                                                  std::size_t body,
                                                  std::size_t member);
  [[nodiscard]] Status add(const Scene& scene,
                           std::span<const StageBody> bodies,
                           const std::string& target,
                           const std::string& body,
                           bool by_action);

  std::vector<TargetUse> uses_;
  std::vector<std::optional<glm::dvec3>> held_;  ///< One for each use.
  std::vector<std::vector<std::size_t>> uses_of_body_;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> by_pair_;
};

/// Returns a position on a path for a user: turned, moved and scaled if the target's
/// frame is the body's. Precondition: it is no point of a body.
[[nodiscard]] glm::dvec3 path_for(const SceneTarget& target,
                                  const StageBody& user,
                                  double time_s);

}  // namespace marey::app
