// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <exception>
#include <map>
#include <string_view>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <tiny_gltf.h>

#include "recordings/base/atomic_file.h"
#include "recordings/base/motion_limits.h"
#include "recordings/base/nesting.h"
#include "recordings/base/other_kind.h"
#include "recordings/gltf/gltf_extensions.h"
#include "recordings/gltf/gltf_files.h"
#include "recordings/gltf/gltf_model.h"
#include "recordings/gltf/gltf_source.h"

namespace marey::recordings {
namespace {

constexpr std::string_view kGlbMagic = "glTF";
// Headers of the file and of the first chunk.
constexpr std::size_t kGlbHeaderBytes = 20;

std::size_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

/// Returns the JSON text of a file's bytes. Errors: a damaged GLB, in plain words.
Result<std::string> json_of(const NamedModel& file, std::string_view bytes) {
  if (!bytes.starts_with(kGlbMagic)) {
    const std::size_t start =
        std::min(bytes.find_first_not_of(" \t\r\n\xEF\xBB\xBF"), bytes.size());
    if (bytes.substr(start).starts_with('{')) return std::string(bytes);
    if (bytes.starts_with("version https://git-lfs")) {
      return file.fail(
          "this is a note of Git LFS in place of the file (git lfs pull "
          "fetches it)");
    }
    if (const Status ok = check_kind(bytes, file.file, kGltfKind); !ok) {
      return ok.error();
    }
    return file.fail("this is neither a GLB file nor glTF text");
  }
  if (bytes.size() < kGlbHeaderBytes) return file.fail("the file ends in its header");
  if (word_at(bytes, 4) != 2) {
    return file.fail("this is glTF " + std::to_string(word_at(bytes, 4)) +
                     ", marey reads glTF 2");
  }
  const std::size_t announced = word_at(bytes, 8);
  if (announced > bytes.size()) {
    return file.fail("the file is cut short: it holds " + std::to_string(bytes.size()) +
                     " of " + std::to_string(announced) + " bytes");
  }
  const std::size_t json_bytes = word_at(bytes, 12);
  if (json_bytes > bytes.size() - kGlbHeaderBytes || bytes.substr(16, 4) != "JSON") {
    return file.fail("the first chunk of the GLB is not the JSON it should be");
  }
  return std::string(bytes.substr(kGlbHeaderBytes, json_bytes));
}

/// Keeps an image's bytes unchanged, because marey does not use its pixels. An image in a
/// buffer is left to copy_buffered_images(): its range is not checked yet.
bool keep_image(tinygltf::Image* image,
                const int place,
                std::string* /*error*/,
                std::string* /*warning*/,
                int /*width*/,
                int /*height*/,
                const unsigned char* bytes,
                int size,
                void* images) {
  if (image->bufferView >= 0) return true;
  auto& kept = *static_cast<std::map<int, std::string>*>(images);
  kept[place].assign(reinterpret_cast<const char*>(bytes),
                     static_cast<std::size_t>(size));
  return true;
}

std::string one_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == '.')) text.pop_back();
  std::ranges::replace(text, '\n', ' ');
  return text.empty() ? "the file is not valid glTF" : text;
}

Status load_model(const NamedModel& file,
                  const std::filesystem::path& path,
                  const std::string& bytes,
                  tinygltf::Model& model,
                  GltfSource& source) {
  tinygltf::TinyGLTF loader;
  std::map<int, std::string> images;
  loader.SetImageLoader(keep_image, &images);
  ExternalFiles files;
  read_external_files(loader, files);
  std::string error;
  std::string warning;
  const std::string folder = path.parent_path().string();
  const auto size = static_cast<unsigned int>(bytes.size());
  bool loaded = false;
  try {
    loaded = bytes.starts_with(kGlbMagic)
                 ? loader.LoadBinaryFromMemory(
                       &model,
                       &error,
                       &warning,
                       reinterpret_cast<const unsigned char*>(bytes.data()),
                       size,
                       folder)
                 : loader.LoadASCIIFromString(
                       &model, &error, &warning, bytes.data(), size, folder);
  } catch (const std::exception& problem) {
    error = problem.what();
  }
  if (!loaded) return file.fail(one_line(error));
  if (const Status ok = check_extensions(file); !ok) return ok;
  if (Status s = check_referred_numbers(file); !s) return s;
  for (const auto& buffer : model.buffers) {
    source.buffers.emplace_back(buffer.data.begin(), buffer.data.end());
  }
  if (Status s = copy_buffered_images(file, source.images); !s) return s;
  for (auto& [place, data] : images) {
    const auto i = static_cast<std::size_t>(place);
    if (i < source.images.size()) source.images[i] = std::move(data);
  }
  return Done{};
}

NodePose pose_of(const tinygltf::Node& node) {
  NodePose pose;
  if (node.matrix.size() == 16) {
    const auto& m = node.matrix;
    glm::dmat3 axes(m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]);
    for (int i = 0; i < 3; ++i) {
      pose.scale[i] = glm::length(axes[i]);
      if (pose.scale[i] > 0.0) axes[i] /= pose.scale[i];
    }
    if (glm::determinant(axes) < 0.0) {
      pose.scale.x = -pose.scale.x;
      axes[0] = -axes[0];
    }
    pose.rotation = glm::normalize(glm::quat_cast(axes));
    pose.translation = {m[12], m[13], m[14]};
    return pose;
  }
  const auto& r = node.rotation;
  const auto& t = node.translation;
  const auto& s = node.scale;
  if (r.size() == 4) {
    const glm::dquat rotation(r[3], r[0], r[1], r[2]);
    if (glm::length(rotation) > 1e-6) pose.rotation = glm::normalize(rotation);
  }
  if (t.size() == 3) pose.translation = {t[0], t[1], t[2]};
  if (s.size() == 3) pose.scale = {s[0], s[1], s[2]};
  return pose;
}

Result<NodeTree> tree_of(const NamedModel& file) {
  const auto& nodes = file.model.nodes;
  NodeTree tree;
  tree.parent.resize(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    tree.rest.push_back(pose_of(nodes[i]));
    for (const int child : nodes[i].children) {
      if (child < 0 || static_cast<std::size_t>(child) >= nodes.size()) {
        return file.fail("node " + std::to_string(i) +
                         " has a child that does not exist");
      }
      auto& parent = tree.parent[static_cast<std::size_t>(child)];
      if (parent) {
        return file.fail("node " + std::to_string(child) + " has two parents");
      }
      parent = i;
    }
  }
  // Depth first, so that a humanoid keeps the order of human_bones().
  std::vector<std::size_t> open;
  for (std::size_t i = nodes.size(); i-- > 0;) {
    if (!tree.parent[i]) open.push_back(i);
  }
  std::vector<std::size_t> level(nodes.size(), 1);
  while (!open.empty()) {
    const std::size_t node = open.back();
    open.pop_back();
    tree.parents_first.push_back(node);
    const auto& children = nodes[node].children;
    for (const int child : children) {
      level[static_cast<std::size_t>(child)] = level[node] + 1;
    }
    if (level[node] > kMaxSkeletonDepth) {
      return file.fail("its nodes are nested more than " +
                       std::to_string(kMaxSkeletonDepth) + " deep");
    }
    for (auto child = children.rbegin(); child != children.rend(); ++child) {
      open.push_back(static_cast<std::size_t>(*child));
    }
  }
  if (tree.parents_first.size() != nodes.size()) {
    return file.fail("some nodes are their own ancestors");
  }
  return tree;
}

/// Returns the joints' nodes as write_retargeted() needs them.
std::vector<NodeOfJoint> nodes_of_joints(const NodeTree& tree, const NodeSkeleton& body) {
  const PlacedNodes placed = place_nodes(tree, tree.rest);
  std::vector<NodeOfJoint> nodes;
  for (const std::size_t node : body.node_of_joint) {
    NodeOfJoint out;
    out.rotation = tree.rest[node].rotation;
    out.translation = tree.rest[node].translation;
    out.world_scale = glm::length(glm::dvec3(placed.world_from_node[node][0]));
    const auto above = tree.parent[node];
    if (above && body.joint_of_node[*above]) {
      out.parent_joint = index(*body.joint_of_node[*above]);
    }
    out.world_from_parent =
        above ? placed.world_from_node[*above] : glm::mat4_cast(tree.world_from_file);
    out.parent_rotation = above ? placed.rotation[*above] : tree.world_from_file;
    nodes.push_back(out);
  }
  return nodes;
}

/// Per joint: true if vertices are skinned to it.
std::vector<bool> carriers_of(const std::optional<SkinnedMesh>& mesh,
                              std::size_t joints) {
  if (!mesh) return {};
  std::vector<bool> carries(joints, false);
  for (const SkinWeights& skin : mesh->skin) {
    for (std::size_t k = 0; k < 4; ++k) {
      if (skin.weights[k] > 0.0) carries[index(skin.joints[k])] = true;
    }
  }
  return carries;
}

/// Returns the body in its skin's bind pose, if its rest pose differs.
Result<std::optional<BoundBody>> bound_body(
    const NamedModel& file,
    const NodeTree& tree,
    const NodeSkeleton& body,
    const std::map<std::size_t, HumanBone>& bones) {
  auto poses = bound_poses(file, tree, body);
  if (!poses) return poses.error();
  if (!*poses) return std::optional<BoundBody>{};
  NodeTree bound = tree;
  bound.rest = **std::move(poses);
  auto skeleton = skeleton_of(file, bound, bones);
  // Unusable bind matrices, without other errors of the file.
  if (!skeleton) return std::optional<BoundBody>{};
  auto mesh = read_skinned_mesh(file, bound, *skeleton);
  if (!mesh) return mesh.error();
  return std::optional<BoundBody>{
      BoundBody{std::move(skeleton->skeleton), *std::move(mesh)}};
}

/// Loads a model after a check of its JSON's nesting.
Status load_checked(const NamedModel& file,
                    const std::filesystem::path& path,
                    const std::string& bytes,
                    tinygltf::Model& model,
                    GltfSource& source) {
  auto json = json_of(file, bytes);
  if (!json) return json.error();
  source.json = *std::move(json);
  if (json_nests_too_deep(source.json)) {
    return file.fail("its JSON is nested more than " + std::to_string(kMaxNesting) +
                     " deep");
  }
  return load_model(file, path, bytes, model, source);
}

Status fill_source(const NamedModel& file, GltfSource& source) {
  bool faces_back = false;
  const auto bones = bones_of(file.model, faces_back);
  auto tree = tree_of(file);
  if (!tree) return tree.error();
  if (faces_back) tree->world_from_file = glm::dquat(0.0, 0.0, 1.0, 0.0);
  auto body = skeleton_of(file, *tree, bones);
  if (!body) return body.error();
  auto mesh = read_skinned_mesh(file, *tree, *body);
  if (!mesh) return mesh.error();
  auto animation = read_animation(file, *tree, *body);
  if (!animation) return animation.error();

  auto bound = bound_body(file, *tree, *body, bones);
  if (!bound) return bound.error();

  source.nodes = nodes_of_joints(*tree, *body);
  source.world_from_file = tree->world_from_file;
  const std::vector<bool> carries_skin = carriers_of(*mesh, body->node_of_joint.size());
  const auto above = tree->parent[body->node_of_joint[0]];
  const PlacedNodes placed = place_nodes(*tree, tree->rest);
  source.world_from_root_parent =
      above ? placed.world_from_node[*above] : glm::mat4_cast(tree->world_from_file);
  source.world_from_root_parent_rotation =
      above ? placed.rotation[*above] : tree->world_from_file;
  for (const std::size_t node : body->node_of_joint) {
    source.node_of_joint.push_back(static_cast<int>(node));
  }
  source.character = {std::move(body->skeleton),
                      *std::move(mesh),
                      std::move(animation->motion),
                      animation->ignored_translation_m,
                      faces_back,
                      source.node_of_joint,
                      carries_skin,
                      *std::move(bound),
                      std::move(animation->names)};
  return Done{};
}

}  // namespace

PlacedNodes place_nodes(const NodeTree& tree, std::span<const NodePose> poses) {
  PlacedNodes placed;
  placed.world_from_node.resize(poses.size());
  placed.rotation.resize(poses.size());
  for (const std::size_t node : tree.parents_first) {
    const NodePose& pose = poses[node];
    glm::dmat4 local = glm::mat4_cast(pose.rotation);
    for (int i = 0; i < 3; ++i) local[i] *= pose.scale[i];
    local[3] = glm::dvec4(pose.translation, 1.0);
    const auto parent = tree.parent[node];
    placed.world_from_node[node] = (parent ? placed.world_from_node[*parent]
                                           : glm::mat4_cast(tree.world_from_file)) *
                                   local;
    placed.rotation[node] = glm::normalize(
        (parent ? placed.rotation[*parent] : tree.world_from_file) * pose.rotation);
  }
  return placed;
}

Result<GltfSource> read_gltf_source(const std::filesystem::path& path) {
  const Result<std::string> bytes = read_file(path);
  if (!bytes) return bytes.error();
  return parse_gltf_source(*bytes, path);
}

Result<GltfSource> parse_gltf_source(const std::string& bytes,
                                     const std::filesystem::path& path,
                                     const ReadCharacterOptions& options) {
  tinygltf::Model model;
  const NamedModel file{model, path.string()};
  GltfSource source;
  Status ok = load_checked(file, path, bytes, model, source);
  if (ok) ok = select_animation(file.file, options.animation, model);
  if (!ok) return ok.error();
  if (Status s = fill_source(file, source); !s) return s.error();
  return source;
}

Status load_nodes(const std::string& bytes,
                  const std::filesystem::path& path,
                  tinygltf::Model& model,
                  NodeTree& tree,
                  NodeSkeleton& body) {
  const NamedModel file{model, path.string()};
  GltfSource source;
  if (Status s = load_checked(file, path, bytes, model, source); !s) return s;
  bool faces_back = false;
  const auto bones = bones_of(model, faces_back);
  auto nodes = tree_of(file);
  if (!nodes) return nodes.error();
  tree = *std::move(nodes);
  auto skeleton = skeleton_of(file, tree, bones);
  if (!skeleton) return skeleton.error();
  body = *std::move(skeleton);
  return Done{};
}

Result<Character> read_character(const std::filesystem::path& path,
                                 const ReadCharacterOptions& options) {
  const Result<std::string> bytes = read_file(path);
  return bytes ? parse_character(*bytes, path, options) : bytes.error();
}

Result<Character> parse_character(const std::string& bytes,
                                  const std::filesystem::path& path,
                                  const ReadCharacterOptions& options) {
  auto source = parse_gltf_source(bytes, path, options);
  if (!source) return source.error();
  return std::move(source->character);
}

}  // namespace marey::recordings
