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
#include "recordings/gltf/gltf_bodies.h"
#include "recordings/gltf/gltf_builder.h"
#include "recordings/gltf/gltf_source.h"

namespace marey::recordings {
namespace {

Json empty_document() {
  return {{"asset", {{"version", "2.0"}, {"generator", "marey"}}},
          {"scene", 0},
          {"scenes", Json::array({Json{{"nodes", Json::array()}}})},
          {"nodes", Json::array()}};
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
  std::vector<NodeTrack> tracks =
      tracks_of(motion.poses, motion.skeleton.joints.size(), 0);
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
  Json document = empty_document();
  std::string buffer;
  GltfBuilder builder(document, buffer);
  (void)add_body(document, builder, skeleton, mesh);
  if (motion != nullptr && !motion->poses.empty()) {
    const std::size_t joints = skeleton.joints.size();
    MAREY_ASSERT(motion->skeleton.joints.size() == joints);
    document["animations"] =
        Json::array({make_animation(builder,
                                    tracks_of(motion->poses, joints, 0),
                                    motion->poses.size(),
                                    motion->rate,
                                    clip)});
  }
  return write_file(path, builder.glb());
}

Status write_characters(const std::filesystem::path& path,
                        std::span<const BodyClip> bodies,
                        FrameRate rate,
                        std::string_view clip) {
  Json document = empty_document();
  std::string buffer;
  GltfBuilder builder(document, buffer);
  std::vector<NodeTrack> tracks;
  std::size_t frames = 0;
  for (const BodyClip& body : bodies) {
    const SkinnedMesh none;
    const std::size_t first = add_body(document,
                                       builder,
                                       *body.skeleton,
                                       body.mesh == nullptr ? none : *body.mesh,
                                       body.name + ".");
    for (NodeTrack& track : tracks_of(body.poses, body.skeleton->joints.size(), first)) {
      tracks.push_back(std::move(track));
    }
    frames = body.poses.size();
  }
  if (frames > 0) {
    document["animations"] =
        Json::array({make_animation(builder, tracks, frames, rate, clip)});
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
