// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "core/motion.h"
#include "core/result.h"
#include "core/skeleton.h"
#include "recordings/mesh.h"

namespace marey::recordings {

/// A body in the pose in which its skin was bound.
struct BoundBody {
  Skeleton skeleton;  ///< The character's joints, with another rest.
  std::optional<SkinnedMesh> mesh;
};

/// A rigged body from a glTF file.
struct Character {
  /// The smallest tree of nodes that holds the skins' joints and the humanoid's bones; of
  /// all nodes when there are neither. Trees of nodes that have nothing in common are one
  /// skeleton, that of the most joints first: the others hang on its root. Rests as the
  /// file's nodes do, turned to face +Z when the file is a VRM 0.x, in which bodies face
  /// -Z.
  Skeleton skeleton;
  /// All skinned triangles, brought to the skeleton's rest pose; nullopt without a skin.
  std::optional<SkinnedMesh> mesh;
  /// The first animation, if any; its skeleton is `skeleton`.
  std::optional<Motion> motion;
  /// The largest movement of a joint against its parent that `motion` left out, because a
  /// Pose moves only the root. Movement of the first joint that branches (the hips) is
  /// handed to the root and not lost. [m]
  double ignored_translation_m = 0.0;
  bool faces_back = false;  ///< In the file, a VRM 0.x; here it was turned round.
  /// Which of the file's nodes each joint is.
  std::vector<int> node_of_joint;
  /// Whether vertices hang on each joint; empty without a mesh.
  std::vector<bool> carries_skin;
  /// The body as its skin's inverse bind matrices have it, where the nodes rest otherwise
  /// (in a frame of an animation): a joint by more than 5 degrees.
  std::optional<BoundBody> bound;
};

/// Reads a .glb, .vrm, .vrma or .gltf (2.0) file.
///
/// Bones come from the humanoid of VRMC_vrm, VRMC_vrm_animation or VRM (0.x); without
/// these extensions, joints named like VRM bones are those bones. A node without a name
/// gives a joint that is called by its number, "node_7". The animation is
/// sampled at the rate of its keys when they are evenly spaced at 10 Hz or more, else at
/// 30 Hz. Vertices keep their first four joints. Scaled nodes give scaled bone lengths;
/// morph targets, textures and materials beyond the base colour are not read.
///
/// Errors (kBadInput): as read_file()'s; not glTF 2.0, or cut short; a node that carries
/// joints and mirrors them or scales them unevenly (by more than 1 %); compressed or
/// sparse data, any other extension that the file requires and marey does not read, by
/// name; indices, accessors or buffers that do not fit together; nodes without a root; a
/// skin without joints; anything further than 10 km away; an animation of too
/// many frames for memory. Cost: linear in vertices, and in frames times nodes.
[[nodiscard]] Result<Character> read_character(const std::filesystem::path& path);

/// read_character() of a file's bytes. `path` is what messages call it, and where a .gltf
/// has its buffers.
[[nodiscard]] Result<Character> parse_character(const std::string& bytes,
                                                const std::filesystem::path& path);

/// Writes a GLB of the skeleton in its rest pose with its skinned mesh and, unless it is
/// null, one animation of `motion`, called `clip`: linear keys at the motion's rate, the
/// first at time 0; neighbouring quaternions on the same side; nothing is scaled. Nodes
/// are named like the joints. glTF's own validator finds neither errors nor warnings.
/// Replaces the file at once or not at all. Same input, same bytes. Errors as
/// write_file()'s. Linear in vertices and frames.
/// Precondition: the mesh is bound to `skeleton`, which has one root, its first joint;
/// the motion's poses have as many joints.
[[nodiscard]] Status write_character(const std::filesystem::path& path,
                                     const Skeleton& skeleton,
                                     const SkinnedMesh& mesh,
                                     const Motion* motion = nullptr,
                                     std::string_view clip = "motion");

/// How a body was turned and scaled since read_character() gave it.
struct ChangedFrame {
  glm::dquat new_from_read{1.0, 0.0, 0.0, 0.0};
  double scale = 1.0;
  /// The joint as read that each joint of the body is; nullopt: the file has none. Empty:
  /// the body's joints are those that were read, on the parents that they had.
  std::vector<std::optional<JointIndex>> read_joint = {};
  /// The body rests as Character::bound.
  bool rests_as_bound = false;
  /// The scene of the file that is written stands as the body does: a node above its
  /// roots turns it. Else the file keeps its own axes.
  bool turns_scene = false;
};

/// Writes the asset at `source` again as a GLB with `motion`, called `clip`, as its only
/// animation. All
/// else is kept as it is: meshes, materials, textures, extensions. Data of removed
/// animations stay in the file unused. Buffers and images beside a .gltf are taken in.
/// The motion is of the body as `changed` says; the file keeps its own unit, and its own
/// frame unless `changed` turns its scene. Joints that hang elsewhere in the file move
/// against their nodes' parents: they get translations, too.
/// Fails as read_character() does, and when the motion is not of the skeleton that
/// read_character(source) gives.
[[nodiscard]] Status write_retargeted(const std::filesystem::path& source,
                                      const std::filesystem::path& path,
                                      const Motion& motion,
                                      std::string_view clip = "motion",
                                      const ChangedFrame& changed = {});

}  // namespace marey::recordings
