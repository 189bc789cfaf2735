// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <numeric>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <tiny_gltf.h>

#include "recordings/base/motion_limits.h"
#include "recordings/gltf/gltf_model.h"

namespace marey::recordings {
namespace {

/// A skin's joints: world from bind space, and the joint of the skeleton, per skin joint.
struct Binding {
  std::vector<glm::dmat4> world_from_bound;
  std::vector<JointIndex> joints;
};

/// Reads the joints of a skin, without vertices.
Result<BoundSkin> joints_of(const NamedModel& file,
                            const tinygltf::Skin& skin,
                            const NodeSkeleton& body) {
  if (skin.joints.empty()) return file.fail("a skin has no joints");
  BoundSkin out;
  std::vector<double> inverse_binds;
  if (skin.inverseBindMatrices >= 0) {
    auto values = accessor_values(file, skin.inverseBindMatrices, 16);
    if (!values) return values.error();
    inverse_binds = *std::move(values);
    if (inverse_binds.size() < 16 * skin.joints.size()) {
      return file.fail("a skin has fewer inverse bind matrices than joints");
    }
  }
  for (std::size_t i = 0; i < skin.joints.size(); ++i) {
    const auto node = static_cast<std::size_t>(skin.joints[i]);
    glm::dmat4 joint_from_bound(1.0);
    for (std::size_t k = 0; k < 16 && !inverse_binds.empty(); ++k) {
      joint_from_bound[static_cast<int>(k / 4)][static_cast<int>(k % 4)] =
          inverse_binds[16 * i + k];
    }
    out.joint_from_bound.push_back(joint_from_bound);
    out.joints.push_back(*body.joint_of_node[node]);
  }
  return out;
}

Result<Binding> bind(const NamedModel& file,
                     const tinygltf::Skin& skin,
                     const PlacedNodes& placed,
                     const NodeSkeleton& body) {
  auto bound = joints_of(file, skin, body);
  if (!bound) return bound.error();
  Binding binding{{}, std::move(bound->joints)};
  for (std::size_t i = 0; i < skin.joints.size(); ++i) {
    const auto node = static_cast<std::size_t>(skin.joints[i]);
    binding.world_from_bound.push_back(placed.world_from_node[node] *
                                       bound->joint_from_bound[i]);
  }
  return binding;
}

/// The arrays of a primitive, checked for consistency.
struct Vertices {
  std::vector<double> positions, normals, joints, weights;

  [[nodiscard]] std::size_t count() const { return positions.size() / 3; }
};

Result<Vertices> read_vertices(const NamedModel& file,
                               const tinygltf::Primitive& primitive) {
  Vertices vertices;
  const auto read = [&](const char* name,
                        std::size_t components,
                        bool required,
                        std::vector<double>& out) -> Status {
    const auto attribute = primitive.attributes.find(name);
    if (attribute == primitive.attributes.end()) {
      if (!required) return Done{};
      return file.fail(std::string("a skinned mesh has no ") + name);
    }
    auto values = accessor_values(file, attribute->second, components);
    if (!values) return values.error();
    out = *std::move(values);
    if (out.size() / components != vertices.count()) {
      return file.fail(std::string(name) + " does not have one entry per vertex");
    }
    return Done{};
  };
  if (auto s = read("POSITION", 3, true, vertices.positions); !s) return s.error();
  if (auto s = read("NORMAL", 3, false, vertices.normals); !s) return s.error();
  if (auto s = read("JOINTS_0", 4, true, vertices.joints); !s) return s.error();
  if (auto s = read("WEIGHTS_0", 4, true, vertices.weights); !s) return s.error();
  return vertices;
}

/// Returns the weights of vertex `v`, largest first, sum 1, with indices into the skin.
Result<std::array<std::pair<double, std::size_t>, 4>> weights_of(const NamedModel& file,
                                                                 const Vertices& vertices,
                                                                 std::size_t v,
                                                                 std::size_t joints) {
  std::array<std::pair<double, std::size_t>, 4> carriers{};
  double sum = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    const double weight = std::max(0.0, vertices.weights[4 * v + k]);
    const double joint = vertices.joints[4 * v + k];
    if (weight > 0.0 && !(joint >= 0.0 && joint < static_cast<double>(joints))) {
      return file.fail("a vertex refers to joint " +
                       std::to_string(static_cast<long>(joint)) + ", but its skin has " +
                       std::to_string(joints));
    }
    carriers[k] = {weight, weight > 0.0 ? static_cast<std::size_t>(joint) : 0};
    sum += weight;
  }
  if (sum <= 0.0) carriers[0].first = sum = 1.0;
  for (auto& carrier : carriers) carrier.first /= sum;
  std::ranges::stable_sort(
      carriers, [](const auto& a, const auto& b) { return a.first > b.first; });
  return carriers;
}

Status add_vertices(const NamedModel& file,
                    const Vertices& vertices,
                    const Binding& binding,
                    SkinnedMesh& mesh) {
  for (std::size_t v = 0; v < vertices.count(); ++v) {
    const auto carriers = weights_of(file, vertices, v, binding.joints.size());
    if (!carriers) return carriers.error();
    glm::dmat4 world_from_bound(0.0);
    SkinWeights skin;
    for (std::size_t k = 0; k < 4; ++k) {
      const auto [weight, place] = (*carriers)[k];
      if (weight == 0.0) continue;
      world_from_bound += weight * binding.world_from_bound[place];
      skin.joints[k] = binding.joints[place];
      skin.weights[k] = weight;
    }
    const auto triple = [&](const std::vector<double>& list) {
      return glm::dvec3(list[3 * v], list[3 * v + 1], list[3 * v + 2]);
    };
    const glm::dvec3 p(world_from_bound * glm::dvec4(triple(vertices.positions), 1.0));
    // The condition is inverted to include NaN, the result of an overflow.
    if (!(glm::length(p) <= kMaxDistance_m)) {
      return file.fail("a vertex lies further than 10 km away");
    }
    mesh.p_in_world.push_back(p);
    glm::dvec3 normal(0.0, 1.0, 0.0);
    if (!vertices.normals.empty()) {
      const glm::dvec3 turned = glm::dmat3(world_from_bound) * triple(vertices.normals);
      if (glm::length(turned) > 0.0) normal = glm::normalize(turned);
    }
    mesh.normal_in_world.push_back(normal);
    mesh.skin.push_back(skin);
  }
  return Done{};
}

Result<MeshPart> part_of(const NamedModel& file,
                         const tinygltf::Primitive& primitive,
                         std::size_t first_vertex,
                         std::size_t vertex_count) {
  MeshPart part;
  const auto& materials = file.model.materials;
  if (primitive.material >= 0 &&
      static_cast<std::size_t>(primitive.material) < materials.size()) {
    const auto& material = materials[static_cast<std::size_t>(primitive.material)];
    const auto& colour = material.pbrMetallicRoughness.baseColorFactor;
    part.material.name = material.name;
    part.material.roughness = material.pbrMetallicRoughness.roughnessFactor;
    if (colour.size() == 4) part.material.base_colour = {colour[0], colour[1], colour[2]};
  }
  std::vector<double> places(vertex_count);
  std::iota(places.begin(), places.end(), 0.0);
  if (primitive.indices >= 0) {
    auto values = accessor_values(file, primitive.indices, 1);
    if (!values) return values.error();
    places = *std::move(values);
  }
  places.resize(places.size() / 3 * 3);
  for (const double place : places) {
    if (place < 0.0 || place >= static_cast<double>(vertex_count)) {
      return file.fail("a triangle has a corner that does not exist");
    }
    part.triangles.push_back(
        static_cast<std::uint32_t>(first_vertex + static_cast<std::size_t>(place)));
  }
  return part;
}

Status add_mesh(const NamedModel& file,
                const tinygltf::Mesh& source,
                const Binding& binding,
                SkinnedMesh& mesh) {
  for (const tinygltf::Primitive& primitive : source.primitives) {
    // -1: the file omits the mode, which means triangles.
    if (primitive.mode != TINYGLTF_MODE_TRIANGLES && primitive.mode != -1) continue;
    const auto vertices = read_vertices(file, primitive);
    if (!vertices) return vertices.error();
    auto part = part_of(file, primitive, mesh.p_in_world.size(), vertices->count());
    if (!part) return part.error();
    if (auto s = add_vertices(file, *vertices, binding, mesh); !s) return s;
    mesh.parts.push_back(*std::move(part));
  }
  return Done{};
}

Status add_bound(const NamedModel& file, const tinygltf::Mesh& source, BoundSkin& skin) {
  for (const tinygltf::Primitive& primitive : source.primitives) {
    if (primitive.mode != TINYGLTF_MODE_TRIANGLES && primitive.mode != -1) continue;
    const auto vertices = read_vertices(file, primitive);
    if (!vertices) return vertices.error();
    for (std::size_t v = 0; v < vertices->count(); ++v) {
      const auto carriers = weights_of(file, *vertices, v, skin.joints.size());
      if (!carriers) return carriers.error();
      const double* p = &vertices->positions[3 * v];
      skin.p_in_bound.emplace_back(p[0], p[1], p[2]);
      skin.carriers.push_back(*carriers);
    }
  }
  return Done{};
}

/// Calls `use` with every skinned mesh and its skin.
template <class Use>
Status each_skinned_mesh(const NamedModel& file, const Use& use) {
  const tinygltf::Model& model = file.model;
  for (const tinygltf::Node& node : model.nodes) {
    if (node.mesh < 0 || node.skin < 0) continue;
    if (static_cast<std::size_t>(node.mesh) >= model.meshes.size() ||
        static_cast<std::size_t>(node.skin) >= model.skins.size()) {
      return file.fail("the node '" + node.name + "' has a mesh that does not exist");
    }
    const Status ok = use(model.meshes[static_cast<std::size_t>(node.mesh)],
                          model.skins[static_cast<std::size_t>(node.skin)]);
    if (!ok) return ok;
  }
  return Done{};
}

}  // namespace

Result<std::vector<BoundSkin>> read_bound_skins(const NamedModel& file,
                                                const NodeSkeleton& body) {
  std::vector<BoundSkin> out;
  const Status ok = each_skinned_mesh(
      file, [&](const tinygltf::Mesh& mesh, const tinygltf::Skin& skin) -> Status {
        auto bound = joints_of(file, skin, body);
        if (!bound) return bound.error();
        out.push_back(*std::move(bound));
        return add_bound(file, mesh, out.back());
      });
  if (!ok) return ok.error();
  return out;
}

Result<std::optional<SkinnedMesh>> read_skinned_mesh(const NamedModel& file,
                                                     const NodeTree& tree,
                                                     const NodeSkeleton& body) {
  const PlacedNodes placed = place_nodes(tree, tree.rest);
  SkinnedMesh mesh;
  const Status ok = each_skinned_mesh(
      file, [&](const tinygltf::Mesh& source, const tinygltf::Skin& skin) -> Status {
        const auto binding = bind(file, skin, placed, body);
        if (!binding) return binding.error();
        return add_mesh(file, source, *binding, mesh);
      });
  if (!ok) return ok.error();
  if (mesh.parts.empty()) return std::optional<SkinnedMesh>{};
  return std::optional<SkinnedMesh>{std::move(mesh)};
}

}  // namespace marey::recordings
