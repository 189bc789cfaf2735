// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "core/base/result.h"
#include "core/motion.h"
#include "recordings/gltf/gltf.h"
#include "recordings/motion/bvh.h"
#include "retarget/body/body_map.h"

namespace marey::app {

/// The kinds of files that hold the motion of a body.
enum class MotionFormat { kGlb, kBvh, kVrma, kNpz, kCsv, kMot };

[[nodiscard]] std::span<const MotionFormat> motion_formats();
/// "glb", "bvh", ...: a file's extension without its point.
[[nodiscard]] std::string_view name(MotionFormat format);
[[nodiscard]] std::optional<MotionFormat> motion_format(std::string_view name);

/// The file whose mesh a body has; empty: none. And how the body was changed since.
struct BodyLook {
  std::filesystem::path file;
  recordings::ChangedFrame changed;
};

struct MotionFileOptions {
  recordings::BvhWriteOptions bvh;
  std::string clip = "motion";  ///< What an animation in GLB or VRMA is called.
};

/// World rotations of all joints in the T-pose facing +Z: of those that carry no bone, as
/// at rest. Precondition: `map` is of the skeleton.
[[nodiscard]] std::vector<glm::dquat> t_pose_of(const Skeleton& skeleton,
                                                const retarget::BodyMap& map);

/// The bytes of a VRM animation of a body in marey's frame, whose bones are marked,
/// whatever its rest pose.
/// Errors (kBadInput): map_body()'s and vrma_bytes()'s: no humanoid.
[[nodiscard]] Result<std::string> vrma_of(const Motion& motion, const std::string& clip);

/// Why a body cannot have a file of this kind, whatever its motion: .glb needs a look,
/// .vrma the bones of VRM's humanoid, .mot the skeleton that marey makes. Success: it
/// can.
[[nodiscard]] Status can_hold(MotionFormat format,
                              const Skeleton& skeleton,
                              const BodyLook& look);

/// Writes the motion of a body as a file of this kind, at once or not at all: .glb with
/// the body's own look, .npz with the contacts of its feet. Same input, same bytes.
/// Errors: can_hold()'s, naming `out`; the disk.
[[nodiscard]] Status write_motion_file(const std::filesystem::path& out,
                                       MotionFormat format,
                                       const Motion& motion,
                                       const BodyLook& look,
                                       const MotionFileOptions& options = {});

}  // namespace marey::app
