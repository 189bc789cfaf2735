// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <nlohmann/json.hpp>

#include "core/pose.h"
#include "core/transform.h"
#include "recordings/gltf/gltf_source.h"

namespace marey::recordings {
namespace {

/// Positions of the joints of the file, in the file's frame.
class ReadPlaces {
 public:
  ReadPlaces(const Motion& motion, const ChangedFrame& changed, std::size_t joints)
      : motion_(motion),
        changed_(changed),
        world_(motion.skeleton.joints.size()),
        read_(joints) {}

  const std::vector<RigidTransform>& at(const Pose& pose) {
    world_from_joints(motion_.skeleton, pose, world_);
    const glm::dquat read_from_new = glm::conjugate(changed_.new_from_read);
    for (std::size_t i = 0; i < world_.size(); ++i) {
      auto read = std::optional(JointIndex{static_cast<int>(i)});
      if (!changed_.read_joint.empty()) read = changed_.read_joint[i];
      if (!read) continue;
      read_[index(*read)] = {glm::normalize(read_from_new * world_[i].rotation),
                             read_from_new * (world_[i].translation / changed_.scale)};
    }
    return read_;
  }

 private:
  const Motion& motion_;
  const ChangedFrame& changed_;
  std::vector<RigidTransform> world_;
  std::vector<RigidTransform> read_;
};

/// Returns a joint's transform in its node's parent, in the file's unit.
RigidTransform in_node(const GltfSource& source,
                       const std::vector<RigidTransform>& world,
                       std::size_t joint) {
  const NodeOfJoint& node = source.nodes[joint];
  const RigidTransform& own = world[joint];
  if (!node.parent_joint) {
    return {glm::conjugate(node.parent_rotation) * own.rotation,
            glm::dvec3(glm::inverse(node.world_from_parent) *
                       glm::dvec4(own.translation, 1.0))};
  }
  const RigidTransform& parent = world[*node.parent_joint];
  const double scale = source.nodes[*node.parent_joint].world_scale;
  const glm::dquat back = glm::conjugate(parent.rotation);
  return {back * own.rotation, back * (own.translation - parent.translation) / scale};
}

bool stays(const std::vector<glm::dvec3>& places, const glm::dvec3& rest) {
  const double near = 1e-5 * (1e-3 + glm::length(rest));
  return std::ranges::all_of(
      places, [&](const glm::dvec3& p) { return glm::distance(p, rest) < near; });
}

bool stays(const std::vector<glm::dquat>& turns, const glm::dquat& rest) {
  return std::ranges::all_of(turns, [&](const glm::dquat& q) {
    return std::abs(glm::dot(q, rest)) > 1.0 - 1e-12;
  });
}

}  // namespace

bool matches_node_hierarchy(const GltfSource& source, const ChangedFrame& changed) {
  if (changed.rests_as_bound || !changed.read_joint.empty()) return false;
  const auto& joints = source.character.skeleton.joints;
  for (std::size_t i = 1; i < joints.size(); ++i) {
    if (!source.nodes[i].parent_joint) return false;
  }
  return true;
}

std::vector<NodeTrack> tracks_against_nodes(const GltfSource& source,
                                            const Motion& motion,
                                            const ChangedFrame& changed) {
  const std::size_t joints = source.nodes.size();
  std::vector<NodeTrack> tracks(joints);
  ReadPlaces places(motion, changed, joints);
  for (const Pose& pose : motion.poses) {
    const auto& world = places.at(pose);
    for (std::size_t i = 0; i < joints; ++i) {
      const RigidTransform local = in_node(source, world, i);
      tracks[i].rotations.push_back(glm::normalize(local.rotation));
      tracks[i].translations.push_back(local.translation);
    }
  }
  for (std::size_t i = 0; i < joints; ++i) {
    NodeTrack& track = tracks[i];
    track.node = source.node_of_joint[i];
    if (i == 0) continue;
    if (stays(track.rotations, source.nodes[i].rotation)) track.rotations.clear();
    if (stays(track.translations, source.nodes[i].translation)) {
      track.translations.clear();
    }
  }
  return tracks;
}

void set_bind_pose_as_rest(const Skeleton& body,
                           const ChangedFrame& changed,
                           GltfSource& source,
                           Json& document) {
  const Motion rest{body, FrameRate{30.0}, 0, {}};
  ReadPlaces places(rest, changed, source.nodes.size());
  const auto& world = places.at(rest_pose(body));
  for (std::size_t i = 0; i < source.nodes.size(); ++i) {
    const RigidTransform local = in_node(source, world, i);
    const glm::dquat turn = glm::normalize(local.rotation);
    const glm::dvec3& t = local.translation;
    Json& node = document["nodes"].at(static_cast<std::size_t>(source.node_of_joint[i]));
    node["rotation"] = Json::array({turn.x, turn.y, turn.z, turn.w});
    node["translation"] = Json::array({t.x, t.y, t.z});
    source.nodes[i].rotation = turn;
    source.nodes[i].translation = t;
  }
}

void turn_scenes(Json& document, const glm::dquat& turn) {
  const bool is_turned = std::abs(turn.w) < 1.0 - 1e-12;
  if (!is_turned || !document.contains("scenes")) return;
  // The added node above a root that belongs to several scenes.
  std::map<std::size_t, std::size_t> turned;
  for (Json& scene : document["scenes"]) {
    if (!scene.contains("nodes") || scene["nodes"].empty()) continue;
    const std::size_t above = document["nodes"].size();
    Json children = Json::array();
    Json nodes = Json::array();
    for (const Json& root : scene["nodes"]) {
      // The transforms above a skinned mesh are ignored, so it stays at the scene's root.
      const Json& node = document["nodes"].at(root.get<std::size_t>());
      if (node.contains("skin") && !node.contains("children")) {
        nodes.push_back(root);
        continue;
      }
      const auto [it, is_new] = turned.emplace(root.get<std::size_t>(), above);
      if (is_new) {
        children.push_back(root);
      } else if (std::ranges::find(nodes, Json(it->second)) == nodes.end()) {
        nodes.push_back(it->second);
      }
    }
    if (!children.empty()) {
      document["nodes"].push_back(
          {{"name", "facing"},
           {"rotation", Json::array({turn.x, turn.y, turn.z, turn.w})},
           {"children", std::move(children)}});
      nodes.push_back(above);
    }
    scene["nodes"] = std::move(nodes);
  }
}

}  // namespace marey::recordings
