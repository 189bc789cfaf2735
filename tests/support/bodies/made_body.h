// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "core/humanoid.h"

namespace marey::testing {

/// Properties of a generated body. Angles in degrees, lengths of the finished body in m.
struct MadeBodyRule {
  double stature_m = 1.7;
  double legs = 1.0;  ///< Over an average body's of that stature; trunk, arms, head too.
  double trunk = 1.0;
  double arms = 1.0;
  double head = 1.0;
  double thick = 1.0;          ///< Factor of the radii of limbs and trunk.
  double shoes = 1.0;          ///< Length of the feet's skin.
  int naming = 0;              ///< 0 Mixamo, 1 Unreal, 2 VRM's names, 3 Blender, 4 CMU.
  double arms_down_deg = 0.0;  ///< 0 a T-pose, 45 an A-pose.
  double knees_deg = 0.0;      ///< Bent at rest.
  double facing_deg = 0.0;     ///< About Y: 0 is +Z, 90 is +X, 180 is -Z.
  bool centimetres = false;    ///< Below an armature that is scaled by 0.01.
  bool z_up = false;           ///< Below an armature that is turned by -90 about X.
  double root_scale = 1.0;     ///< Scale of a node above the hips.
  bool root_at_floor = false;
  bool twist_bones = false;
  bool ik_bones =
      false;  ///< Feet's targets and knees' poles below the root, without skin.
  bool fingers = false;
  bool hair = false;
  bool ears = false;    ///< A chain of bones above the head, a third of the stature long.
  int spine_bones = 3;  ///< Between hips and neck, 1 to 6.
  bool random_axes = false;   ///< Each joint's axes turned at random.
  bool two_skins = false;     ///< Limbs in a mesh with a skin of their own.
  bool byte_weights = false;  ///< Normalized bytes.
  std::uint64_t seed = 0;     ///< Seed of the random axes.
};

/// A rule by seed: every property drawn, statures of 0.6 to 2.5 m. Same seed, same rule.
[[nodiscard]] MadeBodyRule made_body_rule(std::uint64_t seed);

/// "1.21 m, unreal, A 45, faces 90, cm, twist".
[[nodiscard]] std::string words(const MadeBodyRule& rule);

/// Returns the name of a bone in a naming scheme, and of the i-th bone of the spine.
/// Precondition: `bone` is none of the spine; 0 <= scheme <= 4.
[[nodiscard]] std::string made_bone_name(int scheme, HumanBone bone);
[[nodiscard]] std::string made_spine_name(int scheme, int i);

/// Writes the body as a GLB whose sole is the floor at rest, with its own writer. Returns
/// the name of the node that is each bone. Throws std::runtime_error when the disk fails.
std::map<HumanBone, std::string> write_made_body(const MadeBodyRule& rule,
                                                 const std::filesystem::path& path);

}  // namespace marey::testing
