// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <nlohmann/json.hpp>

#include "core/base/assert.h"
#include "core/humanoid.h"
#include "core/pose.h"
#include "core/transform.h"
#include "recordings/base/atomic_file.h"
#include "recordings/gltf/gltf_builder.h"
#include "recordings/gltf/vrma.h"

namespace marey::recordings {
namespace {

constexpr std::array kRequired{HumanBone::kHips,
                               HumanBone::kSpine,
                               HumanBone::kHead,
                               HumanBone::kLeftUpperArm,
                               HumanBone::kLeftLowerArm,
                               HumanBone::kLeftHand,
                               HumanBone::kRightUpperArm,
                               HumanBone::kRightLowerArm,
                               HumanBone::kRightHand,
                               HumanBone::kLeftUpperLeg,
                               HumanBone::kLeftLowerLeg,
                               HumanBone::kLeftFoot,
                               HumanBone::kRightUpperLeg,
                               HumanBone::kRightLowerLeg,
                               HumanBone::kRightFoot};

/// A bone of the file: its joint, and its parent among the previous nodes.
struct BoneNode {
  HumanBone bone{};
  std::size_t joint = 0;
  std::optional<std::size_t> parent;
};

Error missing(std::string cause) {
  return bad_input(
      "",
      std::move(cause),
      "name the body's bones, or retarget the motion on a body that has them");
}

bool is_below(const Skeleton& skeleton, std::size_t joint, std::size_t above) {
  for (auto at = skeleton.joints[joint].parent; at; at = skeleton[*at].parent) {
    if (index(*at) == above) return true;
  }
  return false;
}

/// Returns the bones of VRM, parents first; a bone without the parent that VRM requires
/// is omitted.
Result<std::vector<BoneNode>> bone_nodes(const Skeleton& skeleton) {
  std::vector<BoneNode> nodes;
  std::array<std::optional<std::size_t>, kHumanBoneCount> node_of{};
  for (const HumanBone bone : human_bones()) {
    const auto joint = skeleton.find(bone);
    const bool required = std::ranges::find(kRequired, bone) != kRequired.end();
    if (!joint) {
      if (!required) continue;
      return missing("no joint is the " + std::string(name(bone)) +
                     ", which VRM requires");
    }
    BoneNode node{bone, index(*joint), std::nullopt};
    for (auto above = parent(bone); above && !node.parent; above = parent(*above)) {
      node.parent = node_of[index(*above)];
    }
    if (node.parent && !is_below(skeleton, node.joint, nodes[*node.parent].joint)) {
      return missing("the " + std::string(name(bone)) + " does not lie below the " +
                     std::string(name(nodes[*node.parent].bone)));
    }
    // VRM's upper chest requires a chest.
    if (bone == HumanBone::kUpperChest && !node_of[index(HumanBone::kChest)]) continue;
    node_of[index(bone)] = nodes.size();
    nodes.push_back(node);
  }
  return nodes;
}

double lowest_m(const Skeleton& skeleton, std::span<const RigidTransform> joints) {
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < joints.size(); ++i) {
    lowest = std::min(lowest, joints[i].translation.y);
    const auto& tip = skeleton.joints[i].tip_in_joint;
    if (tip) lowest = std::min(lowest, (joints[i] * *tip).y);
  }
  return lowest;
}

/// Returns every joint in the T-pose, at the height of the rest pose above the floor.
std::vector<RigidTransform> t_pose(const Skeleton& skeleton,
                                   std::span<const glm::dquat> rotations) {
  const Pose rest = rest_pose(skeleton);
  const auto resting = world_from_joints(skeleton, rest);
  if (rotations.empty()) return resting;
  auto posed = world_from_joints(
      skeleton, pose_from_world(skeleton, rest.root_in_world, rotations));
  const double rise_m = lowest_m(skeleton, resting) - lowest_m(skeleton, posed);
  for (RigidTransform& joint : posed) joint.translation.y += rise_m;
  return posed;
}

Json json_array(const glm::dvec3& v) {
  return Json::array({v.x, v.y, v.z});
}

/// Adds the nodes at rest, and the mapping from bones to nodes.
void add_nodes(Json& document,
               std::span<const BoneNode> nodes,
               std::span<const RigidTransform> t_pose) {
  Json list = Json::array();
  Json bones = Json::object();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto& [bone, joint, parent] = nodes[i];
    glm::dvec3 place = t_pose[joint].translation;
    if (parent) place -= t_pose[nodes[*parent].joint].translation;
    list.push_back({{"name", name(bone)}, {"translation", json_array(place)}});
    if (parent) list[*parent]["children"].push_back(i);
    bones[std::string(name(bone))] = {{"node", i}};
  }
  document["nodes"] = std::move(list);
  document["extensionsUsed"] = Json::array({"VRMC_vrm_animation"});
  document["extensions"] = {
      {"VRMC_vrm_animation",
       {{"specVersion", "1.0"}, {"humanoid", {{"humanBones", std::move(bones)}}}}}};
}

/// Offset of a child node from its parent, at rest and in the posture, scaled to the
/// distance at rest.
struct ChildWay {
  glm::dvec3 rest{0.0};
  glm::dvec3 posed{0.0};
};

/// Returns the rotation nearest to `turn` that best aligns the children's offsets at rest
/// with those of the posture: joints in between that are no bones have moved them.
glm::dquat aimed(glm::dquat turn, std::span<const ChildWay> ways) {
  constexpr int kSteps = 16;
  constexpr double kExact_m = 1e-9;
  for (int step = 0; step < kSteps; ++step) {
    glm::dvec3 moment(0.0);
    glm::dmat3 inertia(0.0);
    double away_m = 0.0;
    double size_m2 = 0.0;
    for (const ChildWay& way : ways) {
      const glm::dvec3 now = turn * way.rest;
      moment += glm::cross(now, way.posed - now);
      inertia += glm::dmat3(glm::dot(now, now)) - glm::outerProduct(now, now);
      away_m = std::max(away_m, glm::distance(now, way.posed));
      size_m2 += glm::dot(now, now);
    }
    if (away_m < kExact_m || size_m2 <= 0.0) break;
    // The rotation about the direction of a single child is not determined.
    inertia += glm::dmat3(1e-9 * size_m2);
    turn = glm::normalize(rotation_from_vector(glm::inverse(inertia) * moment) * turn);
  }
  return turn;
}

/// Returns the children of each node.
std::vector<std::vector<std::size_t>> children_of(std::span<const BoneNode> nodes) {
  std::vector<std::vector<std::size_t>> out(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].parent) out[*nodes[i].parent].push_back(i);
  }
  return out;
}

/// Per node: true if joints that are no bones are between it and its child.
std::vector<bool> has_joints_between(const Skeleton& skeleton,
                                     std::span<const BoneNode> nodes) {
  std::vector<bool> out(nodes.size(), false);
  for (const BoneNode& node : nodes) {
    if (!node.parent) continue;
    const auto& above = skeleton.joints[node.joint].parent;
    if (above && index(*above) != nodes[*node.parent].joint) out[*node.parent] = true;
  }
  return out;
}

std::vector<NodeTrack> tracks_of(const Motion& motion,
                                 std::span<const BoneNode> nodes,
                                 std::span<const RigidTransform> t_pose) {
  std::vector<NodeTrack> tracks(nodes.size());
  for (std::size_t i = 0; i < tracks.size(); ++i) tracks[i].node = static_cast<int>(i);
  std::vector<RigidTransform> world_from_joint(t_pose.size());
  std::vector<glm::dquat> turned(nodes.size());
  const auto children = children_of(nodes);
  const auto is_aimed = has_joints_between(motion.skeleton, nodes);
  std::vector<glm::dvec3> place(nodes.size());  // As in the file.
  std::vector<ChildWay> ways;
  for (const Pose& pose : motion.poses) {
    world_from_joints(motion.skeleton, pose, world_from_joint);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const auto& [bone, joint, parent] = nodes[i];
      turned[i] =
          world_from_joint[joint].rotation * glm::conjugate(t_pose[joint].rotation);
      const glm::dvec3 rests_at = t_pose[joint].translation;
      if (parent) {
        place[i] =
            place[*parent] +
            turned[*parent] * (rests_at - t_pose[nodes[*parent].joint].translation);
      } else {
        place[i] = world_from_joint[joint].translation;
      }
      if (is_aimed[i]) {
        ways.clear();
        for (const std::size_t child : children[i]) {
          const std::size_t own = nodes[child].joint;
          const glm::dvec3 rest = t_pose[own].translation - rests_at;
          const glm::dvec3 posed = world_from_joint[own].translation - place[i];
          const double posed_m = glm::length(posed);
          // A rotation cannot change the distance.
          if (posed_m > 0.0)
            ways.push_back({rest, posed * (glm::length(rest) / posed_m)});
        }
        turned[i] = aimed(turned[i], ways);
      }
      tracks[i].rotations.push_back(parent ? glm::conjugate(turned[*parent]) * turned[i]
                                           : turned[i]);
    }
    tracks[0].translations.push_back(world_from_joint[nodes[0].joint].translation);
  }
  return tracks;
}

}  // namespace

Result<std::string> vrma_bytes(const Motion& motion, const VrmaOptions& options) {
  const std::size_t joints = motion.skeleton.joints.size();
  MAREY_ASSERT(joints > 0 && motion.rate.hz > 0.0);
  MAREY_ASSERT(options.t_pose_from_joint.empty() ||
               options.t_pose_from_joint.size() == joints);
  const auto nodes = bone_nodes(motion.skeleton);
  if (!nodes) return nodes.error();
  const auto rest = t_pose(motion.skeleton, options.t_pose_from_joint);
  Json document{{"asset", {{"version", "2.0"}, {"generator", "marey"}}},
                {"scene", 0},
                {"scenes", Json::array({Json{{"nodes", Json::array({0})}}})}};
  std::string buffer;
  GltfBuilder builder(document, buffer);
  add_nodes(document, *nodes, rest);
  if (!motion.poses.empty()) {
    document["animations"] = Json::array({make_animation(builder,
                                                         tracks_of(motion, *nodes, rest),
                                                         motion.poses.size(),
                                                         motion.rate,
                                                         options.clip)});
  }
  return builder.glb();
}

Status write_vrma(const std::filesystem::path& path,
                  const Motion& motion,
                  const VrmaOptions& options) {
  Result<std::string> bytes = vrma_bytes(motion, options);
  if (bytes) return write_file(path, *bytes);
  Error error = bytes.error();
  error.where = path.string();
  return error;
}

}  // namespace marey::recordings
