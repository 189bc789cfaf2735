// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "engine/engine.h"
#include <glm/vec3.hpp>

#include "app/stage/run/stage_record.h"
#include "core/engine/scene.h"

namespace marey::app {

/// A target and a body that uses it.
struct TargetUse {
  std::size_t target = 0;
  std::size_t user = 0;
  /// Position of the user in the group that uses the target: the k-th user has the k-th
  /// body of a BodyPointPath.
  std::size_t member = 0;
};

/// Returns the uses of all targets by actions and figures of a scene, in their order,
/// each once.
[[nodiscard]] std::vector<TargetUse> target_uses(const Scene& scene);

/// Places of the targets of a scene: on their paths, on bodies, or where they are held.
class TargetPlaces {
 public:
  /// Borrows both; they must outlive it. Precondition: the scene was read without errors
  /// and `bodies` are those of scene_bodies().
  TargetPlaces(const Scene& scene, std::span<const StageBody> bodies);

  /// Returns the place at a time. A point of a body is that of its last step, or before
  /// its first step that of the rest pose at its start. Allocates nothing.
  [[nodiscard]] glm::dvec3 in_world(const TargetUse& use,
                                    double time_s,
                                    const engine::Engine& engine) const;

  /// See SceneRun::set_target().
  bool hold(std::size_t target,
            const std::optional<glm::dvec3>& p_in_world,
            std::optional<std::size_t> user);

 private:
  struct Held {
    std::size_t target = 0;
    std::optional<std::size_t> user{};
    glm::dvec3 p_in_world{0.0};
  };
  [[nodiscard]] glm::dvec3 on_body(const BodyPointPath& path,
                                   const TargetUse& use,
                                   const engine::Engine& engine) const;

  const Scene& scene_;
  std::span<const StageBody> bodies_;
  std::vector<Held> held_;
};

/// Returns the joint of a segment: a bone by VRM's name or a joint by its own; nullopt:
/// the body has no such segment.
[[nodiscard]] std::optional<JointIndex> joint_of_segment(const StageBody& body,
                                                         const std::string& segment);

/// Returns a point of a body that is posed. Precondition: the joint exists.
[[nodiscard]] glm::dvec3 point_in_world(const StageBody& body,
                                        JointIndex joint,
                                        const glm::dvec3& offset_in_t_pose,
                                        std::span<const RigidTransform> world_from_joint);

}  // namespace marey::app
