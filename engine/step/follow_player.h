// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "engine/actions/action.h"
#include "engine/models/follow_course.h"
#include "engine/step/rehearsal.h"
#include <glm/vec3.hpp>

#include "core/base/ids.h"
#include "core/base/result.h"
#include "retarget/adapt/adapter.h"

namespace marey::engine {

/// A request that a point of the body follows a target at once, without a clip.
struct FollowWish {
  /// Id of a constraint of the character whose goal is a DistanceToPoint: one of
  /// CharacterSpec::constraints, or "reach left" or "reach right" for the palms of a
  /// character with CharacterSpec::reaches.
  std::string constraint = "reach right";
  glm::dvec3 target_in_world{0.0};
  FollowSettings settings;
  double fade_out_s =
      0.4;  ///< Time in which the point returns to the clips when it stops.
};

/// The point of a constraint on a body.
struct FollowPoint {
  std::string id;
  JointIndex joint{};
  glm::dvec3 offset_in_t_pose{0.0};
};

/// Answer about a follow, from lengths: the point's distance and the limits of its way.
struct FollowFeasibility {
  bool reachable = false;
  double missing_m = 0.0;   ///< For the palms: distance from the places within reach.
  double duration_s = 0.0;  ///< Until the point is at a target that rests.
  int steps = 0;            ///< The same in steps of the engine.
};

/// Leads one point of a character after a target with limited speed and acceleration, by
/// FollowCourse. The point starts where it is shown, with the velocity of the clips.
/// Below 10 us for the first step, 1 us for others; allocates nothing in a step.
class FollowPlayer {
 public:
  /// Errors (bad input): those of FollowCourse::start(); a target that is not finite; a
  /// fade that is not in [0, 100] s. `skeleton` and `map` must outlive it.
  [[nodiscard]] static Result<FollowPlayer> make(ActionId id,
                                                 const FollowWish& wish,
                                                 const FollowPoint& point,
                                                 const Skeleton& skeleton,
                                                 const retarget::BodyMap& map,
                                                 retarget::Adapter::Handle handle);

  [[nodiscard]] ActionId id() const { return id_; }
  [[nodiscard]] const FollowPoint& point() const { return point_; }
  /// Moves the target. Error: not finite.
  [[nodiscard]] Status aim(const glm::dvec3& target_in_world);
  /// Begins the return to the clips.
  void stop() { stops_ = true; }
  [[nodiscard]] bool is_stopping() const { return stops_; }
  /// Ends it at once, for another model of this point.
  void drop(double time_s);

  /// Moves the target of the constraint; false: it is over, and the constraint is
  /// stopped. `posed`: the joints after the last step; `reference`: those of the blend.
  bool step(double time_s,
            double step_s,
            const BlendPlayer& blend,
            std::span<const RigidTransform> reference,
            std::span<const RigidTransform> posed,
            const BodyShift& shift);

  [[nodiscard]] const FollowState& last() const { return course_.state(); }

 private:
  FollowPlayer(ActionId id,
               const FollowWish& wish,
               const FollowPoint& point,
               const Skeleton& skeleton,
               const retarget::BodyMap& map,
               retarget::Adapter::Handle handle);
  void begin(double time_s,
             double step_s,
             const BlendPlayer& blend,
             std::span<const RigidTransform> reference,
             std::span<const RigidTransform> posed);

  ActionId id_{};
  FollowWish wish_;
  FollowPoint point_;
  const retarget::BodyMap* map_;
  retarget::Adapter::Handle handle_;
  FollowCourse course_;
  bool has_started_ = false;
  bool stops_ = false;
  double stopped_s_ = -1.0;
  glm::dvec3 carries_m_{0.0};  ///< Displacement of the hips, filtered.
  Rehearsal rehearsal_;
};

/// Returns the place of a point on a posed body.
[[nodiscard]] glm::dvec3 posed_point(std::span<const RigidTransform> world_from_joint,
                                     const retarget::BodyMap& map,
                                     const FollowPoint& point);

/// Returns the duration of the way from rest to rest over a distance within the limits.
[[nodiscard]] double follow_time_s(double distance_m, const FollowSettings& settings);

}  // namespace marey::engine
