// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string_view>

#include <glm/geometric.hpp>
#include <tiny_gltf.h>

#include "core/base/in_quotes.h"
#include "recordings/base/motion_limits.h"
#include "recordings/base/text_reader.h"
#include "recordings/gltf/gltf_model.h"

namespace marey::recordings {
namespace {

/// Returns the nodes that must be joints: those of skins and humanoid, or else all.
Result<std::vector<bool>> wanted_nodes(const NamedModel& file,
                                       const std::map<std::size_t, HumanBone>& bones) {
  const tinygltf::Model& model = file.model;
  std::vector<bool> wanted(model.nodes.size(), false);
  for (const tinygltf::Skin& skin : model.skins) {
    for (const int joint : skin.joints) {
      if (joint < 0 || static_cast<std::size_t>(joint) >= wanted.size()) {
        return file.fail("a skin has a joint that does not exist");
      }
      wanted[static_cast<std::size_t>(joint)] = true;
    }
  }
  for (const auto& [node, bone] : bones) wanted[node] = true;
  if (std::ranges::find(wanted, true) == wanted.end()) wanted.assign(wanted.size(), true);
  return wanted;
}

/// For each tree of nodes, returns the deepest node that is an ancestor of all its wanted
/// nodes, the tree with most wanted nodes first. Sets `below` to the number of wanted
/// nodes at or below each node.
std::vector<std::size_t> roots_of(const NodeTree& tree,
                                  const std::vector<bool>& wanted,
                                  std::vector<std::size_t>& below) {
  below.assign(wanted.size(), 0);
  std::vector<std::size_t> top(wanted.size(), 0);
  std::vector<std::size_t> tops;
  for (auto it = tree.parents_first.rbegin(); it != tree.parents_first.rend(); ++it) {
    if (wanted[*it]) ++below[*it];
    if (tree.parent[*it]) below[*tree.parent[*it]] += below[*it];
  }
  std::vector<std::size_t> deepest(wanted.size(), 0);
  for (const std::size_t node : tree.parents_first) {
    top[node] = tree.parent[node] ? top[*tree.parent[node]] : node;
    if (!tree.parent[node] && below[node] > 0) tops.push_back(node);
    if (below[node] > 0 && below[node] == below[top[node]]) deepest[top[node]] = node;
  }
  std::ranges::stable_sort(
      tops, std::greater<>{}, [&](std::size_t node) { return below[node]; });
  std::vector<std::size_t> roots;
  for (const std::size_t node : tops) roots.push_back(deepest[node]);
  return roots;
}

std::string shown_name(const tinygltf::Model& model, std::size_t node) {
  const std::string& name = model.nodes[node].name;
  return name.empty() ? "number " + std::to_string(node)
                      : in_quotes(std::string_view(name).substr(0, 40));
}

/// Checks that a node is scaled equally in all directions: bones keep their lengths and
/// rotate rigidly.
Status check_scale(const NamedModel& file, const NodeTree& tree, std::size_t node) {
  constexpr double kAlike = 0.01;
  const glm::dvec3& scale = tree.rest[node].scale;
  const double low = std::min({scale.x, scale.y, scale.z});
  const double high = std::max({scale.x, scale.y, scale.z});
  if (!(low > 0.0)) {
    return file.fail("the node " + shown_name(file.model, node) +
                     " of its skeleton has a negative scale or none: it is mirrored");
  }
  if (high - low <= kAlike * high) return Done{};
  return file.fail("the node " + shown_name(file.model, node) +
                   " of its skeleton is not scaled alike in all directions");
}

/// Checks every node that is or carries a wanted one, above the skeleton too.
Status check_scales(const NamedModel& file,
                    const NodeTree& tree,
                    const std::vector<std::size_t>& below) {
  for (const std::size_t node : tree.parents_first) {
    if (below[node] == 0 || !tree.parent[node]) continue;
    if (const Status ok = check_scale(file, tree, *tree.parent[node]); !ok) return ok;
  }
  return Done{};
}

std::size_t top_of(const NodeTree& tree, std::size_t node) {
  while (tree.parent[node]) node = *tree.parent[node];
  return node;
}

/// Returns true if a second node of the same bone belongs to another body: it is in
/// another tree and at another position. Armatures of one body's clothes repeat its bones
/// at the same positions.
bool is_other_body(const NodeTree& tree,
                   const PlacedNodes& placed,
                   std::size_t first,
                   std::size_t second) {
  constexpr double kSamePlace_m = 0.01;
  if (top_of(tree, first) == top_of(tree, second)) return false;
  return glm::distance(glm::dvec3(placed.world_from_node[first][3]),
                       glm::dvec3(placed.world_from_node[second][3])) > kSamePlace_m;
}

Error two_bodies(const NamedModel& file,
                 const NodeTree& tree,
                 std::size_t first,
                 std::size_t second) {
  return file.fail("the file holds two bodies: there is a joint " +
                   shown_name(file.model, first) + " below the node " +
                   shown_name(file.model, top_of(tree, first)) + " and one below " +
                   shown_name(file.model, top_of(tree, second)));
}

/// Returns nodes, parents first, the first root's tree before all others.
std::vector<std::size_t> in_order(const NodeTree& tree,
                                  const std::vector<std::size_t>& roots) {
  std::vector<bool> is_first(tree.rest.size(), false);
  for (const std::size_t node : tree.parents_first) {
    is_first[node] =
        node == roots.front() || (tree.parent[node] && is_first[*tree.parent[node]]);
  }
  std::vector<std::size_t> order = tree.parents_first;
  std::stable_partition(
      order.begin(), order.end(), [&](std::size_t node) { return is_first[node]; });
  return order;
}

}  // namespace

bool is_near(const PlacedNodes& placed, std::size_t node) {
  // The condition includes NaN, the result of an overflow.
  return glm::length(glm::dvec3(placed.world_from_node[node][3])) <= kMaxDistance_m &&
         std::abs(glm::length(placed.rotation[node]) - 1.0) <= 1e-6;
}

std::map<std::size_t, HumanBone> bones_of(const tinygltf::Model& model,
                                          bool& faces_back) {
  std::map<std::size_t, HumanBone> bones;
  const auto add = [&](std::string_view name, const tinygltf::Value& node) {
    const auto bone = human_bone(name);
    const int place = node.IsNumber() ? node.GetNumberAsInt() : -1;
    if (bone && place >= 0 && static_cast<std::size_t>(place) < model.nodes.size()) {
      bones.emplace(static_cast<std::size_t>(place), *bone);
    }
  };
  for (const char* key : {"VRMC_vrm", "VRMC_vrm_animation"}) {
    const auto extension = model.extensions.find(key);
    if (extension == model.extensions.end()) continue;
    const auto& humanoid = extension->second.Get("humanoid").Get("humanBones");
    if (!humanoid.IsObject()) continue;
    for (const std::string& name : humanoid.Keys()) {
      add(name, humanoid.Get(name).Get("node"));
    }
    return bones;
  }
  if (const auto vrm0 = model.extensions.find("VRM"); vrm0 != model.extensions.end()) {
    faces_back = true;
    const auto& humanoid = vrm0->second.Get("humanoid").Get("humanBones");
    for (std::size_t i = 0; humanoid.IsArray() && i < humanoid.ArrayLen(); ++i) {
      const auto& entry = humanoid.Get(static_cast<int>(i));
      const auto& name = entry.Get("bone");
      if (name.IsString()) add(name.Get<std::string>(), entry.Get("node"));
    }
    return bones;
  }
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    if (const auto bone = human_bone(model.nodes[i].name)) bones.emplace(i, *bone);
  }
  return bones;
}

Result<NodeSkeleton> skeleton_of(const NamedModel& file,
                                 const NodeTree& tree,
                                 const std::map<std::size_t, HumanBone>& bones) {
  const auto wanted = wanted_nodes(file, bones);
  if (!wanted) return wanted.error();
  std::vector<std::size_t> below;
  // Trees without bones and skins are ignored if other trees have them.
  const std::vector<std::size_t> roots = roots_of(tree, *wanted, below);
  const bool has_body = !bones.empty() || !file.model.skins.empty();
  if (roots.empty() || (roots.size() > 1 && !has_body)) {
    return file.fail("the joints have no common root");
  }
  const PlacedNodes placed = place_nodes(tree, tree.rest);
  NodeSkeleton body;
  body.joint_of_node.resize(tree.rest.size());
  std::array<std::optional<std::size_t>, kHumanBoneCount> bone_node{};
  for (const std::size_t node : in_order(tree, roots)) {
    const bool is_root = std::ranges::find(roots, node) != roots.end();
    const bool under_root = tree.parent[node] && body.joint_of_node[*tree.parent[node]];
    if (!is_root && (!under_root || below[node] == 0)) continue;
    if (body.skeleton.joints.size() >= kMaxJoints) {
      return file.fail("it has more than " + std::to_string(kMaxJoints) + " joints");
    }
    if (!is_near(placed, node)) {
      return file.fail("the node '" + file.model.nodes[node].name.substr(0, 40) +
                       "' lies further than 10 km away");
    }
    Joint joint;
    joint.name = file.model.nodes[node].name;
    if (joint.name.empty()) joint.name = "node_" + std::to_string(node);
    const glm::dvec3 place(placed.world_from_node[node][3]);
    joint.parent_from_joint = {placed.rotation[node], place};
    if (node != roots.front()) {
      const std::size_t above = under_root ? *tree.parent[node] : roots.front();
      joint.parent = body.joint_of_node[above];
      joint.parent_from_joint = inverse({placed.rotation[above],
                                         glm::dvec3(placed.world_from_node[above][3])}) *
                                joint.parent_from_joint;
    }
    if (const auto bone = bones.find(node); bone != bones.end()) {
      auto& first = bone_node[index(bone->second)];
      if (!first) joint.bone = bone->second;
      if (first && is_other_body(tree, placed, *first, node)) {
        return two_bodies(file, tree, *first, node);
      }
      if (!first) first = node;
    }
    body.joint_of_node[node] = JointIndex{static_cast<int>(body.node_of_joint.size())};
    body.node_of_joint.push_back(node);
    body.skeleton.joints.push_back(std::move(joint));
  }
  if (const Status ok = check_scales(file, tree, below); !ok) return ok.error();
  return body;
}

}  // namespace marey::recordings
