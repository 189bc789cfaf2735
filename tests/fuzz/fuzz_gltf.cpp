// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "core/base/assert.h"
#include "core/pose.h"
#include "recordings/gltf/gltf.h"

namespace {

using namespace marey;
using namespace marey::recordings;

/// Asserts that the mesh's indices are valid and that poses give finite joint places.
void check(const Character& character) {
  const std::size_t joints = character.skeleton.joints.size();
  MAREY_ASSERT(joints > 0);
  if (character.mesh) {
    const SkinnedMesh& mesh = *character.mesh;
    MAREY_ASSERT(mesh.skin.size() == mesh.p_in_world.size());
    for (const SkinWeights& skin : mesh.skin) {
      for (const JointIndex joint : skin.joints) MAREY_ASSERT(index(joint) < joints);
    }
    for (const MeshPart& part : mesh.parts) {
      for (const std::uint32_t corner : part.triangles) {
        MAREY_ASSERT(corner < mesh.p_in_world.size());
      }
    }
  }
  if (!character.motion || joints > 1000) return;
  for (const Pose& pose : character.motion->poses) {
    for (const RigidTransform& joint : world_from_joints(character.skeleton, pose)) {
      MAREY_ASSERT(std::isfinite(glm::dot(joint.translation, joint.translation)));
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  // A file may name others, which are none of the fuzzer's.
  if (bytes.find("uri") != std::string::npos) return 0;
  const Result<Character> character = parse_character(bytes, "fuzz.glb");
  if (character) check(*character);
  return 0;
}
