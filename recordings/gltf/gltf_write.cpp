// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdint>
#include <exception>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

#include "core/base/assert.h"
#include "core/pose.h"
#include "recordings/base/atomic_file.h"
#include "recordings/gltf/gltf.h"
#include "recordings/gltf/gltf_builder.h"
#include "recordings/gltf/gltf_source.h"

namespace marey::recordings {
namespace {

Json array_of(const glm::dvec3& v) {
  return Json::array({v.x, v.y, v.z});
}

Json array_of(const glm::dquat& q) {
  return Json::array({q.x, q.y, q.z, q.w});
}

std::vector<float> floats_of(std::span<const glm::dvec3> list) {
  std::vector<float> values;
  values.reserve(3 * list.size());
  for (const glm::dvec3& v : list) {
    for (int i = 0; i < 3; ++i) values.push_back(static_cast<float>(v[i]));
  }
  return values;
}

/// One node per joint, in the same order.
Json joint_nodes(const Skeleton& skeleton) {
  Json nodes = Json::array();
  for (const Joint& joint : skeleton.joints) {
    Json node{{"name", joint.name}};
    const auto& [rotation, translation] = joint.parent_from_joint;
    if (translation != glm::dvec3(0.0)) node["translation"] = array_of(translation);
    if (rotation != glm::dquat(1.0, 0.0, 0.0, 0.0)) node["rotation"] = array_of(rotation);
    nodes.push_back(std::move(node));
  }
  for (std::size_t i = 1; i < skeleton.joints.size(); ++i) {
    const auto& parent = skeleton.joints[i].parent;
    MAREY_ASSERT(parent.has_value());
    nodes[index(*parent)]["children"].push_back(i);
  }
  return nodes;
}

Json make_skin(GltfBuilder& builder, const Skeleton& skeleton) {
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
    joints.push_back(joints.size());
  }
  return {{"inverseBindMatrices", builder.add_floats(matrices, 16, "MAT4", false)},
          {"skeleton", 0},
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
              std::size_t joint_count) {
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
  document["meshes"] =
      Json::array({Json{{"name", "body"}, {"primitives", std::move(primitives)}}});
}

std::vector<NodeTrack> tracks_of(const Motion& motion) {
  std::vector<NodeTrack> tracks(motion.skeleton.joints.size());
  for (std::size_t joint = 0; joint < tracks.size(); ++joint) {
    tracks[joint].node = static_cast<int>(joint);
    for (const Pose& pose : motion.poses) {
      MAREY_ASSERT(pose.parent_from_joint.size() == tracks.size());
      tracks[joint].rotations.push_back(pose.parent_from_joint[joint]);
    }
  }
  for (const Pose& pose : motion.poses) {
    tracks[0].translations.push_back(pose.root_in_world);
  }
  return tracks;
}

Error not_of_this_body(const std::filesystem::path& source, std::string cause) {
  return bad_input(source.string(),
                   std::move(cause),
                   "retarget the motion on this very avatar before writing it");
}

/// Detects a body that was rotated or scaled in a way that `changed` does not describe.
bool matches_changed_frame(const Skeleton& avatar,
                           const Skeleton& motion,
                           const ChangedFrame& changed) {
  constexpr double kSame = 1e-5;
  bool rests_alike = true;
  for (std::size_t i = 1; i < avatar.joints.size(); ++i) {
    const RigidTransform& read = avatar.joints[i].parent_from_joint;
    const RigidTransform& now = motion.joints[i].parent_from_joint;
    const glm::dvec3 apart = now.translation - changed.scale * read.translation;
    if (glm::length(apart) > kSame * (1.0 + glm::length(now.translation))) return false;
    const double same_turn = std::abs(glm::dot(read.rotation, now.rotation));
    rests_alike = rests_alike && same_turn > 1.0 - kSame;
  }
  const glm::dquat root =
      changed.new_from_read * avatar.joints[0].parent_from_joint.rotation;
  const glm::dquat& now = motion.joints[0].parent_from_joint.rotation;
  return !rests_alike || std::abs(glm::dot(root, now)) > 1.0 - kSame;
}

/// Checks a body whose hierarchy or rest pose differs from the file's: its joints are the
/// file's.
Status check_read_joints(const std::filesystem::path& source,
                         const Skeleton& avatar,
                         const Skeleton& motion,
                         const ChangedFrame& changed) {
  const auto& read_joint = changed.read_joint;
  std::size_t there = 0;
  for (std::size_t i = 0; i < motion.joints.size(); ++i) {
    auto read = std::optional(JointIndex{static_cast<int>(i)});
    if (!read_joint.empty()) read = i < read_joint.size() ? read_joint[i] : std::nullopt;
    if (!read) continue;
    ++there;
    const bool is_same = index(*read) < avatar.joints.size() &&
                         avatar[*read].name == motion.joints[i].name;
    if (is_same) continue;
    return not_of_this_body(
        source, "the motion's joint '" + motion.joints[i].name + "' is not the avatar's");
  }
  if (there == avatar.joints.size()) return Done{};
  return not_of_this_body(source,
                          "the avatar has " + std::to_string(avatar.joints.size()) +
                              " joints, the motion " + std::to_string(there));
}

Status check_body(const std::filesystem::path& source,
                  const Skeleton& avatar,
                  const Skeleton& motion,
                  const ChangedFrame& changed) {
  if (changed.rests_as_bound || !changed.read_joint.empty()) {
    return check_read_joints(source, avatar, motion, changed);
  }
  if (avatar.joints.size() != motion.joints.size()) {
    return not_of_this_body(source,
                            "the avatar has " + std::to_string(avatar.joints.size()) +
                                " joints, the motion " +
                                std::to_string(motion.joints.size()));
  }
  for (std::size_t i = 0; i < avatar.joints.size(); ++i) {
    if (avatar.joints[i].name != motion.joints[i].name) {
      return not_of_this_body(source,
                              "the avatar's joint " + std::to_string(i) + " is '" +
                                  avatar.joints[i].name + "', the motion's '" +
                                  motion.joints[i].name + "'");
    }
  }
  if (!matches_changed_frame(avatar, motion, changed)) {
    return not_of_this_body(
        source, "the avatar and the body of the motion differ in size or direction");
  }
  return Done{};
}

/// Converts the motion to tracks of the source's nodes. Joints that never move get none.
std::vector<NodeTrack> tracks_in_source(const GltfSource& source, const Motion& motion) {
  std::vector<NodeTrack> tracks = tracks_of(motion);
  const glm::dmat4 parent_from_world = glm::inverse(source.world_from_root_parent);
  for (glm::dvec3& place : tracks[0].translations) {
    place = glm::dvec3(parent_from_world * glm::dvec4(place, 1.0));
  }
  for (glm::dquat& rotation : tracks[0].rotations) {
    rotation = glm::conjugate(source.world_from_root_parent_rotation) * rotation;
  }
  const auto& joints = source.character.skeleton.joints;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    tracks[i].node = source.node_of_joint[i];
    const glm::dquat rest = joints[i].parent_from_joint.rotation;
    const bool still = std::ranges::all_of(tracks[i].rotations, [&](const glm::dquat& q) {
      return std::abs(glm::dot(q, rest)) > 1.0 - 1e-12;
    });
    if (i > 0 && still) tracks[i].rotations.clear();
  }
  return tracks;
}

/// An animated node must not have a matrix (glTF 2.0, 3.5.3).
void split_matrix(Json& node) {
  if (!node.contains("matrix")) return;
  glm::dmat4 m(1.0);
  for (int i = 0; i < 16; ++i)
    m[i / 4][i % 4] = node["matrix"].at(static_cast<std::size_t>(i)).get<double>();
  glm::dvec3 scale(1.0);
  glm::dmat3 axes(m);
  for (int i = 0; i < 3; ++i) {
    scale[i] = glm::length(axes[i]);
    if (scale[i] > 0.0) axes[i] /= scale[i];
  }
  node.erase("matrix");
  node["translation"] = array_of(glm::dvec3(m[3]));
  node["rotation"] = array_of(glm::normalize(glm::quat_cast(axes)));
  node["scale"] = array_of(scale);
}

/// Merges the buffers of a .gltf into one.
std::string merge_buffers(Json& document, const std::vector<std::string>& buffers) {
  std::string merged;
  std::vector<std::size_t> starts;
  for (const std::string& buffer : buffers) {
    while (merged.size() % 4 != 0) merged += '\0';
    starts.push_back(merged.size());
    merged += buffer;
  }
  if (!document.contains("bufferViews")) return merged;
  for (Json& view : document["bufferViews"]) {
    const std::size_t start = starts.at(view.at("buffer").get<std::size_t>());
    view["buffer"] = 0;
    if (start > 0) view["byteOffset"] = start + view.value("byteOffset", std::size_t{0});
  }
  return merged;
}

/// Embeds images that are files or data outside of the document.
void embed_images(Json& document,
                  GltfBuilder& builder,
                  const std::vector<std::string>& images) {
  if (!document.contains("images")) return;
  std::size_t place = 0;
  for (Json& image : document["images"]) {
    const std::string& bytes = images.at(place++);
    if (!image.contains("uri") || bytes.empty()) continue;
    image.erase("uri");
    image["mimeType"] = bytes.starts_with("\xFF\xD8") ? "image/jpeg" : "image/png";
    image["bufferView"] = builder.add_view(bytes);
  }
}

std::string retargeted_glb(GltfSource& source,
                           const Motion& motion,
                           std::string_view clip,
                           const ChangedFrame& changed) {
  Json document = Json::parse(source.json);
  std::string buffer = merge_buffers(document, source.buffers);
  GltfBuilder builder(document, buffer);
  embed_images(document, builder, source.images);
  document.erase("animations");
  for (const int node : source.node_of_joint) {
    split_matrix(document["nodes"].at(static_cast<std::size_t>(node)));
  }
  if (changed.rests_as_bound) {
    set_bind_pose_as_rest(motion.skeleton, changed, source, document);
  }
  const std::vector<NodeTrack> tracks =
      matches_node_hierarchy(source, changed)
          ? tracks_in_source(source, motion)
          : tracks_against_nodes(source, motion, changed);
  if (!motion.poses.empty()) {
    document["animations"] = Json::array(
        {make_animation(builder, tracks, motion.poses.size(), motion.rate, clip)});
  }
  if (changed.turns_scene) {
    turn_scenes(document, changed.new_from_read * source.world_from_file);
  }
  return builder.glb();
}

}  // namespace

Status write_character(const std::filesystem::path& path,
                       const Skeleton& skeleton,
                       const SkinnedMesh& mesh,
                       const Motion* motion,
                       std::string_view clip) {
  MAREY_ASSERT(!skeleton.joints.empty());
  MAREY_ASSERT(mesh.skin.size() == mesh.p_in_world.size());
  MAREY_ASSERT(mesh.normal_in_world.size() == mesh.p_in_world.size());
  const std::size_t joints = skeleton.joints.size();
  Json document{{"asset", {{"version", "2.0"}, {"generator", "marey"}}},
                {"scene", 0},
                {"scenes", Json::array({Json{{"nodes", Json::array({0})}}})}};
  std::string buffer;
  GltfBuilder builder(document, buffer);
  document["nodes"] = joint_nodes(skeleton);
  if (!mesh.p_in_world.empty()) {
    // At the scene's root: the transforms above a skinned mesh are ignored.
    document["scenes"][0]["nodes"].push_back(joints);
    document["nodes"].push_back({{"name", "body"}, {"mesh", 0}, {"skin", 0}});
    add_mesh(document, builder, mesh, joints);
  }
  document["skins"] = Json::array({make_skin(builder, skeleton)});
  if (motion != nullptr && !motion->poses.empty()) {
    MAREY_ASSERT(motion->skeleton.joints.size() == joints);
    document["animations"] = Json::array({make_animation(
        builder, tracks_of(*motion), motion->poses.size(), motion->rate, clip)});
  }
  return write_file(path, builder.glb());
}

Status write_retargeted(const std::filesystem::path& source,
                        const std::filesystem::path& path,
                        const Motion& motion,
                        std::string_view clip,
                        const ChangedFrame& changed) {
  MAREY_ASSERT(changed.scale > 0.0);
  Result<GltfSource> asset = read_gltf_source(source);
  if (!asset) return asset.error();
  glm::dmat4 new_from_read = glm::mat4_cast(changed.new_from_read);
  for (int i = 0; i < 3; ++i) new_from_read[i] *= changed.scale;
  asset->world_from_root_parent = new_from_read * asset->world_from_root_parent;
  asset->world_from_root_parent_rotation =
      changed.new_from_read * asset->world_from_root_parent_rotation;
  if (Status s = check_body(source, asset->character.skeleton, motion.skeleton, changed);
      !s) {
    return s;
  }
  std::string bytes;
  try {
    bytes = retargeted_glb(*asset, motion, clip, changed);
  } catch (const std::exception& problem) {
    return bad_input(source.string(), problem.what(), "export the avatar again as .glb");
  }
  return write_file(path, bytes);
}

}  // namespace marey::recordings
