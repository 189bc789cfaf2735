// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/state/edit_state.h"

#include <cmath>
#include <string>
#include <utility>

#include "retarget/contacts/detect_contacts.h"

namespace marey::edit {
namespace {

bool is_finite_pose(const Pose& pose) {
  const glm::dvec3& root = pose.root_in_world;
  if (!std::isfinite(root.x + root.y + root.z)) return false;
  for (const glm::dquat& q : pose.parent_from_joint) {
    if (!std::isfinite(q.w + q.x + q.y + q.z)) return false;
  }
  return true;
}

Status check_motion(const Motion& motion) {
  if (motion.poses.empty()) {
    return bad_input("motion", "has no frames", "give a file with a motion");
  }
  if (!(motion.rate.hz > 0.0) || !std::isfinite(motion.rate.hz)) {
    return bad_input(
        "motion", "has no frame rate", "state its rate with marey convert --rate");
  }
  for (std::size_t frame = 0; frame < motion.poses.size(); ++frame) {
    if (is_finite_pose(motion.poses[frame])) continue;
    return bad_input(
        "frame " + std::to_string(frame),
        "holds a number that is not finite",
        "export the motion again, or cut the frame in the program that made it");
  }
  return Done{};
}

}  // namespace

Result<EditState> make_edit_state(Motion motion,
                                  std::vector<std::vector<JointUncertainty>> uncertainty,
                                  int source) {
  if (const Status ok = check_motion(motion); !ok) return ok.error();
  if (!uncertainty.empty() && uncertainty.size() != motion.poses.size()) {
    return bad_input("uncertainty",
                     "has " + std::to_string(uncertainty.size()) +
                         " frames for a motion of " + std::to_string(motion.poses.size()),
                     "process the session again, so that its files agree");
  }
  auto map = retarget::map_body(motion.skeleton);
  if (!map) return map.error();
  EditState out;
  out.map = std::move(*map);
  out.contacts = retarget::detect_contacts(motion, out.map);
  out.lineage = lineage_of_source(source, static_cast<int>(motion.poses.size()));
  out.motion = std::move(motion);
  out.uncertainty = std::move(uncertainty);
  return out;
}

}  // namespace marey::edit
