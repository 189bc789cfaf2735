// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/pose.h"
#include "core/skeleton.h"
#include "recordings/body/mesh.h"
#include "recordings/gltf/gltf_builder.h"

namespace marey::recordings {

[[nodiscard]] Json array_of(const glm::dvec3& v);
/// In glTF's order: x, y, z, w.
[[nodiscard]] Json array_of(const glm::dquat& q);

/// Appends a body to a document: one node per joint, in the skeleton's order, then one of
/// its skin, which has a mesh unless that is empty. All names begin with `prefix`. The
/// nodes of the root joint and of the mesh become roots of the first scene. Returns the
/// index of the first node. Preconditions: the mesh is bound to `skeleton`, which has one
/// root, its first joint; the document has the scene, `nodes` is an array.
std::size_t add_body(Json& document,
                     GltfBuilder& builder,
                     const Skeleton& skeleton,
                     const SkinnedMesh& mesh,
                     const std::string& prefix = {});

/// Returns the keys of a body's nodes. Precondition: poses of so many joints.
[[nodiscard]] std::vector<NodeTrack> tracks_of(std::span<const Pose> poses,
                                               std::size_t joints,
                                               std::size_t first_node);

}  // namespace marey::recordings
