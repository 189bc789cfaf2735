// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/body_point.h"

#include <glm/gtc/quaternion.hpp>

#include "retarget/constraints/resolve_segment.h"

namespace marey::app {

std::optional<PointOfBody> point_of_body(const Skeleton& skeleton,
                                         const retarget::BodyMap& map,
                                         const BodyPoint& point) {
  const auto joint = retarget::resolve_segment(skeleton, point.segment);
  if (!joint) return std::nullopt;
  const glm::dquat t_pose_from_joint = map.joints[index(*joint)].t_pose_from_joint;
  return PointOfBody{*joint, glm::conjugate(t_pose_from_joint) * point.offset_in_t_pose};
}

}  // namespace marey::app
