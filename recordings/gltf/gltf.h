// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "core/base/result.h"
#include "core/motion.h"
#include "core/skeleton.h"
#include "recordings/body/mesh.h"

namespace marey::recordings {

/// A body in its skin's bind pose.
struct BoundBody {
  Skeleton skeleton;  ///< The character's joints, with another rest pose.
  std::optional<SkinnedMesh> mesh;
};

/// A rigged body from a glTF file.
struct Character {
  /// The smallest tree of nodes that contains the skins' joints and the humanoid's bones;
  /// all nodes if there are neither. Disjoint trees form one skeleton: the tree with most
  /// joints is first, and the others are attached to its root. The rest pose is that of
  /// the file's nodes, turned to face +Z for a VRM 0.x, in which bodies face -Z.
  Skeleton skeleton;
  /// All skinned triangles, transformed to the skeleton's rest pose; nullopt without a
  /// skin.
  std::optional<SkinnedMesh> mesh;
  /// The chosen animation, if there is any; its skeleton is `skeleton`.
  std::optional<Motion> motion;
  /// Largest movement of a joint relative to its parent that `motion` does not contain,
  /// because a Pose moves only the root. Movement of the first joint that branches (the
  /// hips) is transferred to the root and not lost. [m]
  double ignored_translation_m = 0.0;
  bool faces_back = false;  ///< The file is a VRM 0.x facing -Z; `skeleton` faces +Z.
  /// Index of each joint's node in the file.
  std::vector<int> node_of_joint;
  /// Per joint: true if vertices are skinned to it; empty without a mesh.
  std::vector<bool> carries_skin;
  /// The body in the pose of its skin's inverse bind matrices, if the nodes' rest pose
  /// differs (as in a frame of an animation): by more than 5 degrees for some joint.
  std::optional<BoundBody> bound;
  /// Names of all animations of the file, which may be empty.
  std::vector<std::string> animations;
};

struct ReadCharacterOptions {
  std::size_t animation = 0;  ///< Index of the animation that becomes the motion.
};

/// Reads a .glb, .vrm, .vrma or .gltf (2.0) file.
///
/// Bones come from the humanoid of VRMC_vrm, VRMC_vrm_animation or VRM (0.x); without
/// these extensions, joints named like VRM bones are those bones. The joint of a node
/// without a name is named by the node's number, "node_7". The animation is sampled at
/// the rate of its keys if they are evenly spaced at 10 Hz or more, else at 30 Hz.
/// Vertices keep their first four joints. Scaled nodes give scaled bone lengths; morph
/// targets, textures and materials beyond the base colour are not read.
///
/// Errors (kBadInput): those of read_file(); not glTF 2.0, or incomplete; a node that
/// carries joints and mirrors them or scales them unevenly (by more than 1 %); compressed
/// or sparse data, or any other required extension that marey does not read, by name;
/// inconsistent indices, accessors or buffers; nodes without a root; a skin without
/// joints; a position beyond 10 km; an animation of too many frames for memory; an index
/// of an animation that does not exist, unless it is 0. Cost: linear in vertices, and in
/// frames times nodes.
[[nodiscard]] Result<Character> read_character(const std::filesystem::path& path,
                                               const ReadCharacterOptions& options = {});

/// Applies read_character() to a file's bytes. `path` is the name in messages; the
/// buffers of a .gltf are in its folder.
[[nodiscard]] Result<Character> parse_character(const std::string& bytes,
                                                const std::filesystem::path& path,
                                                const ReadCharacterOptions& options = {});

/// Writes a GLB of the skeleton in its rest pose with its skinned mesh (with a skin, but
/// no mesh if `mesh` is empty) and, unless `motion` is null, one animation of it, named
/// `clip`: linear keys at the motion's rate, the first at time 0; neighbouring
/// quaternions have the same sign; no scale. Nodes are named like the joints. glTF's own
/// validator finds neither errors nor warnings. The file is replaced as a whole or not at
/// all. Same input, same bytes. Errors: those of write_file(). Linear in vertices and
/// frames. Preconditions: the mesh is bound to `skeleton`, which has one root, its first
/// joint; the motion's poses have as many joints.
[[nodiscard]] Status write_character(const std::filesystem::path& path,
                                     const Skeleton& skeleton,
                                     const SkinnedMesh& mesh,
                                     const Motion* motion = nullptr,
                                     std::string_view clip = "motion");

/// One body of a file with several, and its motion.
struct BodyClip {
  std::string name{};                  ///< Different for all bodies of the file.
  const Skeleton* skeleton = nullptr;  ///< Not nullptr.
  const SkinnedMesh* mesh = nullptr;   ///< Bound to the skeleton; nullptr: none.
  std::span<const Pose> poses{};       ///< As many as those of the other bodies.
};

/// Writes a GLB of several bodies with one animation of them all. Nodes are named by the
/// body and the joint: "ann.hips". Otherwise as write_character(), also its errors and
/// preconditions.
[[nodiscard]] Status write_characters(const std::filesystem::path& path,
                                      std::span<const BodyClip> bodies,
                                      FrameRate rate,
                                      std::string_view clip = "motion");

/// Rotation, scale and joints of a body relative to the result of read_character().
struct ChangedFrame {
  glm::dquat new_from_read{1.0, 0.0, 0.0, 0.0};
  double scale = 1.0;
  /// For each joint of the body its joint in the file; nullopt: the file has none. Empty:
  /// the body has the joints and parents of the file.
  std::vector<std::optional<JointIndex>> read_joint = {};
  /// The body's rest pose is that of Character::bound.
  bool rests_as_bound = false;
  /// The written scene has the body's orientation, by a node above the scene's roots.
  /// Otherwise the file keeps its own axes.
  bool turns_scene = false;
};

/// Writes the asset at `source` again as a GLB with `motion`, named `clip`, as its only
/// animation. All other content is unchanged: meshes, materials, textures, extensions.
/// Data of removed animations stay in the file unused. Buffers and images next to a .gltf
/// are embedded. The motion belongs to the body described by `changed`; the file keeps
/// its own unit, and its own axes unless `changed` turns its scene. Joints with other
/// parents in the file move relative to their nodes' parents, so they also get
/// translations. Errors: those of read_character(); the motion is not of the skeleton of
/// read_character(source).
[[nodiscard]] Status write_retargeted(const std::filesystem::path& source,
                                      const std::filesystem::path& path,
                                      const Motion& motion,
                                      std::string_view clip = "motion",
                                      const ChangedFrame& changed = {});

}  // namespace marey::recordings
