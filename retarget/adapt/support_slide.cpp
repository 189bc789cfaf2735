// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/adapt/support_slide.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "core/pose.h"
#include "retarget/constraints/measure_constraint.h"
#include "retarget/feet/floor_at.h"

namespace marey::retarget {

std::vector<SupportSlide> slides_of(const SupportTrack& track,
                                    const Motion& adapted,
                                    const Character& character,
                                    const Floor& floor) {
  const CarriedPoint point = carried_point(character, track.constraint.point);
  std::vector<RigidTransform> world_from_joint(adapted.skeleton.joints.size());
  std::vector<SupportSlide> out;
  for (const FloorStance& stance : track.stands) {
    SupportSlide slide{stance, 0.0};
    glm::dvec3 begin_on_part(0.0);
    for (int t = stance.frames.first; t <= stance.frames.last; ++t) {
      world_from_joints(
          adapted.skeleton, adapted.poses[static_cast<std::size_t>(t)], world_from_joint);
      const double time_s =
          (adapted.first_frame + static_cast<double>(t)) / adapted.rate.hz;
      glm::dvec3 on_part = point.in_world(world_from_joint);
      if (stance.part) on_part -= moved_at(floor.parts[*stance.part], time_s);
      if (t == stance.frames.first) begin_on_part = on_part;
      slide.slide_m = std::max(slide.slide_m, glm::distance(on_part, begin_on_part));
    }
    out.push_back(slide);
  }
  return out;
}

}  // namespace marey::retarget
