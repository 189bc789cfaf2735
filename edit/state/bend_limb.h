// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/pose.h"
#include "core/skeleton.h"
#include "core/transform.h"
#include "retarget/body/body_map.h"

namespace marey::edit {

/// Moves the ends of limbs analytically, in double precision. Only the rotations of the
/// limb's three joints change, so joints without a bone (twist bones, fingers) keep
/// theirs.
class LimbBender {
 public:
  /// Both must outlive the object. Precondition: `map` was made from `skeleton`.
  LimbBender(const Skeleton& skeleton, const retarget::BodyMap& map);

  /// Moves the end of a limb (as in human_limbs()) to a place in the world: the lower
  /// bone turns about the elbow or knee, in the limb's plane, then the whole limb turns
  /// by the smallest rotation. The extremity has the rotation `world_from_end`; without
  /// one it follows the lower bone. Returns the distance to the target that remains
  /// because the limb is too short, or cannot fold as far. [m] Costs one forward
  /// kinematics. Precondition: the body has the limb.
  double move_end(int limb,
                  const glm::dvec3& end_in_world,
                  const std::optional<glm::dquat>& world_from_end,
                  Pose& pose);

 private:
  const Skeleton& skeleton_;
  const retarget::BodyMap& map_;
  std::vector<RigidTransform> joints_;
};

}  // namespace marey::edit
