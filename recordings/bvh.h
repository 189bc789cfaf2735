// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/motion.h"
#include "core/result.h"

namespace marey::recordings {

/// Order of the rotation channels: kZxy writes "Zrotation Xrotation Yrotation", which
/// means R = Rz * Rx * Ry.
enum class BvhOrder {
  kZxy,  ///< What most software writes.
  kZyx,  ///< MotionBuilder's and LaFAN1's.
};

struct BvhWriteOptions {
  BvhOrder order = BvhOrder::kZxy;
  /// Length of the file's unit: 0.01 writes centimetres, 1 writes metres. [m]
  double unit_m = 0.01;
};

struct BvhReadOptions {
  /// Length of the file's unit; the format does not say. [m]
  double unit_m = 0.01;
};

/// What a BVH file says, as marey can hold it.
struct BvhMotion {
  Motion motion;
  /// BVH can move every joint against its parent; a Pose moves only the root. Movement of
  /// the first joint that branches (the hips, below a helper root) is handed to the root
  /// exactly. This is the largest movement of any other joint, which was left out.
  double ignored_translation_m = 0.0;
};

/// The BVH file of a motion, six decimals, Y up. The zero pose is the skeleton's rest
/// pose and the root's place is wholly in its channels (OFFSET 0 0 0), because readers
/// disagree on whether a root's OFFSET counts. A skeleton whose rest rotations are not
/// identity is written with joint axes parallel to the world's, so that every joint has
/// the same place in the world. Angles are continuous from frame to frame. first_frame is
/// not kept, nor are tips of joints that have children; blanks in names become '_'.
/// Precondition: one root, which is the first joint; every pose has one rotation per
/// joint; unit_m > 0.
[[nodiscard]] std::string bvh_text(const Motion& motion,
                                   const BvhWriteOptions& options = {});

/// Writes bvh_text() to `path`, replacing the file at once or not at all. Errors as
/// write_file()'s.
[[nodiscard]] Status write_bvh(const std::filesystem::path& path,
                               const Motion& motion,
                               const BvhWriteOptions& options = {});

/// Reads a BVH text: any order and number of channels per joint, any case of keywords.
/// `file` is what error messages call it.
///
/// Joints are at rest as the OFFSETs say, axes parallel to the world's. Position channels
/// replace the OFFSET, as in Blender and MotionBuilder. A root with no OFFSET rests at
/// the height at which the lowest joint or tip stands on the floor. Joints that carry
/// VRM's bone names, and only those, get their `bone`. The rate is rounded to a whole
/// number when Frame Time, which has few digits, is within 1e-4 of it.
///
/// Errors (kBadInput), with the line: not a BVH file, or one that is cut short; a second
/// ROOT; a joint with the same bone or with CHANNELS twice; an unknown channel; a row
/// with another number of values, or that is no number; more frames than announced; an
/// OFFSET or a position beyond 10 km; a rate outside 0.1 to 2000 Hz.
/// Cost: linear in the text, about 50 MB/s.
[[nodiscard]] Result<BvhMotion> parse_bvh(std::string_view text,
                                          const std::string& file,
                                          const BvhReadOptions& options = {});

/// parse_bvh() of the file at `path`. Errors also as read_file()'s.
[[nodiscard]] Result<BvhMotion> read_bvh(const std::filesystem::path& path,
                                         const BvhReadOptions& options = {});

}  // namespace marey::recordings
