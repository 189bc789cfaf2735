// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/live/vmc/unity_receiver.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

namespace marey::live {
namespace {

const glm::dmat4 kMirror = glm::scale(glm::dmat4(1.0), glm::dvec3(-1.0, 1.0, 1.0));

glm::dmat4 matrix(const glm::dvec3& p, const glm::dquat& q) {
  return glm::translate(glm::dmat4(1.0), p) * glm::mat4_cast(q);
}

/// Local transforms one below the other.
std::vector<glm::dmat4> placed(const Skeleton& avatar, std::vector<glm::dmat4> nodes) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto parent = avatar.joints[i].parent;
    if (parent) nodes[i] = nodes[index(*parent)] * nodes[i];
  }
  return nodes;
}

}  // namespace

std::vector<glm::dmat4> unity_nodes(const Skeleton& avatar) {
  std::vector<glm::dmat4> nodes;
  for (const Joint& joint : avatar.joints) {
    const RigidTransform& local = joint.parent_from_joint;
    nodes.push_back(kMirror * matrix(local.translation, local.rotation) * kMirror);
  }
  return nodes;
}

std::vector<glm::dmat4> normalised_unity_nodes(const Skeleton& avatar) {
  const auto world = placed(avatar, unity_nodes(avatar));
  std::vector<glm::dmat4> nodes;
  for (std::size_t i = 0; i < world.size(); ++i) {
    const auto parent = avatar.joints[i].parent;
    const glm::dvec3 above =
        parent ? glm::dvec3(world[index(*parent)][3]) : glm::dvec3(0.0);
    nodes.push_back(glm::translate(glm::dmat4(1.0), glm::dvec3(world[i][3]) - above));
  }
  return nodes;
}

std::vector<glm::dmat4> shown_in_unity(const Skeleton& avatar,
                                       std::vector<glm::dmat4> local,
                                       const VmcPose& sent) {
  for (std::size_t i = 0; i < local.size(); ++i) {
    const auto bone = avatar.joints[i].bone;
    if (!bone || !sent.contains(unity_bone(*bone))) continue;
    const UnityTransform& set = sent.local[index(unity_bone(*bone))];
    local[i] = matrix(set.position, set.rotation);
  }
  auto world = placed(avatar, std::move(local));
  const glm::dmat4 root = matrix(sent.root.position, sent.root.rotation);
  for (glm::dmat4& node : world) node = root * node;
  return world;
}

}  // namespace marey::live
