// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/body/mesh.h"

#include "core/base/assert.h"

namespace marey::recordings {

std::vector<glm::dvec3> posed_vertices(const SkinnedMesh& mesh,
                                       const Skeleton& skeleton,
                                       const Pose& pose) {
  MAREY_ASSERT(mesh.skin.size() == mesh.p_in_world.size());
  const auto world_from_rest = world_from_joints(skeleton, rest_pose(skeleton));
  std::vector<RigidTransform> moved_from_rest = world_from_joints(skeleton, pose);
  for (std::size_t i = 0; i < moved_from_rest.size(); ++i) {
    moved_from_rest[i] = moved_from_rest[i] * inverse(world_from_rest[i]);
  }
  std::vector<glm::dvec3> p_in_world;
  p_in_world.reserve(mesh.p_in_world.size());
  for (std::size_t v = 0; v < mesh.p_in_world.size(); ++v) {
    glm::dvec3 sum(0.0);
    for (std::size_t k = 0; k < 4; ++k) {
      const double weight = mesh.skin[v].weights[k];
      if (weight == 0.0) continue;
      sum +=
          weight * (moved_from_rest[index(mesh.skin[v].joints[k])] * mesh.p_in_world[v]);
    }
    p_in_world.push_back(sum);
  }
  return p_in_world;
}

}  // namespace marey::recordings
