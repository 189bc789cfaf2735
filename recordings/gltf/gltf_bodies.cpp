// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/gltf/gltf_bodies.h"

#include <array>
#include <cstdint>
#include <utility>

#include <glm/gtc/quaternion.hpp>

#include "core/base/assert.h"

namespace marey::recordings {
namespace {

std::vector<float> floats_of(std::span<const glm::dvec3> list) {
  std::vector<float> values;
  values.reserve(3 * list.size());
  for (const glm::dvec3& v : list) {
    for (int i = 0; i < 3; ++i) values.push_back(static_cast<float>(v[i]));
  }
  return values;
}

// Appends one node per joint, in the same order.
void add_joint_nodes(Json& nodes, const Skeleton& skeleton, const std::string& prefix) {
  const std::size_t first = nodes.size();
  for (const Joint& joint : skeleton.joints) {
    Json node{{"name", prefix + joint.name}};
    const auto& [rotation, translation] = joint.parent_from_joint;
    if (translation != glm::dvec3(0.0)) node["translation"] = array_of(translation);
    if (rotation != glm::dquat(1.0, 0.0, 0.0, 0.0)) node["rotation"] = array_of(rotation);
    nodes.push_back(std::move(node));
  }
  for (std::size_t i = 1; i < skeleton.joints.size(); ++i) {
    const auto& parent = skeleton.joints[i].parent;
    MAREY_ASSERT(parent.has_value());
    nodes[first + index(*parent)]["children"].push_back(first + i);
  }
}

Json make_skin(GltfBuilder& builder, const Skeleton& skeleton, std::size_t first_node) {
  std::vector<float> matrices;
  Json joints = Json::array();
  for (const RigidTransform& world_from_joint :
       world_from_joints(skeleton, rest_pose(skeleton))) {
    const RigidTransform joint_from_world = inverse(world_from_joint);
    glm::dmat4 matrix = glm::mat4_cast(glm::normalize(joint_from_world.rotation));
    matrix[3] = glm::dvec4(joint_from_world.translation, 1.0);
    for (int column = 0; column < 4; ++column) {
      for (int row = 0; row < 4; ++row) {
        matrices.push_back(static_cast<float>(matrix[column][row]));
      }
    }
    joints.push_back(first_node + joints.size());
  }
  return {{"inverseBindMatrices", builder.add_floats(matrices, 16, "MAT4", false)},
          {"skeleton", first_node},
          {"joints", std::move(joints)}};
}

/// Converts weights to floats whose sum is one within float precision.
std::array<float, 4> float_weights(const SkinWeights& skin) {
  std::array<float, 4> weights{};
  float others = 0.0F;
  for (std::size_t k = 1; k < 4; ++k) {
    weights[k] = static_cast<float>(skin.weights[k]);
    others += weights[k];
  }
  weights[0] = 1.0F - others;
  return weights;
}

Json vertex_attributes(GltfBuilder& builder,
                       const SkinnedMesh& mesh,
                       std::size_t joint_count) {
  std::vector<std::uint32_t> joints;
  std::vector<float> weights;
  for (const SkinWeights& skin : mesh.skin) {
    const auto carried = float_weights(skin);
    for (std::size_t k = 0; k < 4; ++k) {
      joints.push_back(
          carried[k] > 0.0F ? static_cast<std::uint32_t>(index(skin.joints[k])) : 0U);
      weights.push_back(carried[k]);
    }
  }
  const auto positions = floats_of(mesh.p_in_world);
  const auto normals = floats_of(mesh.normal_in_world);
  const auto last_joint = static_cast<std::uint32_t>(joint_count - 1);
  return {
      {"POSITION", builder.add_floats(positions, 3, "VEC3", true, kVertexTarget)},
      {"NORMAL", builder.add_floats(normals, 3, "VEC3", false, kVertexTarget)},
      {"JOINTS_0", builder.add_integers(joints, 4, "VEC4", last_joint, kVertexTarget)},
      {"WEIGHTS_0", builder.add_floats(weights, 4, "VEC4", false, kVertexTarget)}};
}

void add_mesh(Json& document,
              GltfBuilder& builder,
              const SkinnedMesh& mesh,
              std::size_t joint_count,
              const std::string& prefix) {
  const Json attributes = vertex_attributes(builder, mesh, joint_count);
  const auto last_vertex = static_cast<std::uint32_t>(mesh.p_in_world.size() - 1);
  Json primitives = Json::array();
  for (const MeshPart& part : mesh.parts) {
    if (part.triangles.empty()) continue;
    const glm::dvec3& colour = part.material.base_colour;
    document["materials"].push_back(
        {{"name", part.material.name},
         {"pbrMetallicRoughness",
          {{"baseColorFactor", Json::array({colour.r, colour.g, colour.b, 1.0})},
           {"metallicFactor", 0.0},
           {"roughnessFactor", part.material.roughness}}}});
    primitives.push_back(
        {{"attributes", attributes},
         {"indices",
          builder.add_integers(part.triangles, 1, "SCALAR", last_vertex, kIndexTarget)},
         {"material", document["materials"].size() - 1}});
  }
  document["meshes"].push_back(
      Json{{"name", prefix + "body"}, {"primitives", std::move(primitives)}});
}

}  // namespace

Json array_of(const glm::dvec3& v) {
  return Json::array({v.x, v.y, v.z});
}

Json array_of(const glm::dquat& q) {
  return Json::array({q.x, q.y, q.z, q.w});
}

std::size_t add_body(Json& document,
                     GltfBuilder& builder,
                     const Skeleton& skeleton,
                     const SkinnedMesh& mesh,
                     const std::string& prefix) {
  MAREY_ASSERT(!skeleton.joints.empty());
  MAREY_ASSERT(mesh.skin.size() == mesh.p_in_world.size());
  MAREY_ASSERT(mesh.normal_in_world.size() == mesh.p_in_world.size());
  const std::size_t first = document["nodes"].size();
  const std::size_t skin = document.contains("skins") ? document["skins"].size() : 0;
  Json& roots = document["scenes"][0]["nodes"];
  roots.push_back(first);
  add_joint_nodes(document["nodes"], skeleton, prefix);
  if (!mesh.p_in_world.empty()) {
    // At the scene's root: the transforms above a skinned mesh are ignored.
    roots.push_back(document["nodes"].size());
    const std::size_t surface =
        document.contains("meshes") ? document["meshes"].size() : 0;
    document["nodes"].push_back(
        {{"name", prefix + "body"}, {"mesh", surface}, {"skin", skin}});
    add_mesh(document, builder, mesh, skeleton.joints.size(), prefix);
  }
  document["skins"].push_back(make_skin(builder, skeleton, first));
  return first;
}

std::vector<NodeTrack> tracks_of(std::span<const Pose> poses,
                                 std::size_t joints,
                                 std::size_t first_node) {
  std::vector<NodeTrack> tracks(joints);
  for (std::size_t joint = 0; joint < tracks.size(); ++joint) {
    tracks[joint].node = static_cast<int>(first_node + joint);
    for (const Pose& pose : poses) {
      MAREY_ASSERT(pose.parent_from_joint.size() == tracks.size());
      tracks[joint].rotations.push_back(pose.parent_from_joint[joint]);
    }
  }
  for (const Pose& pose : poses) {
    tracks[0].translations.push_back(pose.root_in_world);
  }
  return tracks;
}

}  // namespace marey::recordings
