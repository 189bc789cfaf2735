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

/// Kinds of files for the motion of a body.
enum class MotionFormat { kGlb, kBvh, kVrma, kNpz, kCsv, kMot };

[[nodiscard]] std::span<const MotionFormat> motion_formats();
/// Returns the file extension without its point: "glb", "bvh", ...
[[nodiscard]] std::string_view name(MotionFormat format);
[[nodiscard]] std::optional<MotionFormat> motion_format(std::string_view name);
/// Returns the format of a result by its extension. Errors (kBadInput):
/// check_out_file()'s; a kind of file that is not written.
[[nodiscard]] Result<MotionFormat> output_format(const std::filesystem::path& out);
/// Returns the extensions of all formats, for help and messages: ".glb, .bvh, .vrma,
/// .npz, .csv or .mot".
[[nodiscard]] std::string motion_extensions();

/// The file of a body's mesh (empty: none), and the changes made to the body since.
struct BodyLook {
  std::filesystem::path file;
  recordings::ChangedFrame changed;
};

struct MotionFileOptions {
  recordings::BvhWriteOptions bvh;
  std::string clip = "motion";  ///< Name of the animation in GLB or VRMA.
};

/// Returns the world rotations of all joints in the T-pose facing +Z. Joints without a
/// bone keep their rest rotation. Precondition: `map` is of the skeleton.
[[nodiscard]] std::vector<glm::dquat> t_pose_of(const Skeleton& skeleton,
                                                const retarget::BodyMap& map);

/// Returns the bytes of a VRM animation. The body is in marey's frame, its bones are
/// marked, and its rest pose is arbitrary.
/// Errors (kBadInput): map_body()'s; vrma_bytes()'s, as for a body that is no humanoid.
[[nodiscard]] Result<std::string> vrma_of(const Motion& motion, const std::string& clip);

/// Checks that a body can have a file of this kind, whatever its motion: .glb needs a
/// mesh, .vrma the bones of VRM's humanoid, .mot one of marey's own skeletons. The error
/// states the reason.
[[nodiscard]] Status can_hold(MotionFormat format,
                              const Skeleton& skeleton,
                              const BodyLook& look);

/// Writes the motion of a body as a file of this kind: .glb with the body's own mesh,
/// .npz with its foot contacts. The file appears whole or not at all. Same input, same
/// bytes.
/// Errors: can_hold()'s, with `out`; the disk.
[[nodiscard]] Status write_motion_file(const std::filesystem::path& out,
                                       MotionFormat format,
                                       const Motion& motion,
                                       const BodyLook& look,
                                       const MotionFileOptions& options = {});

}  // namespace marey::app
