// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
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
  kXyz,
  kXzy,
  kYxz,
  kYzx,
};

/// What joints are called that are human bones.
enum class BvhNames {
  kOwn,      ///< By their own names, of which only blanks become '_'.
  kHumanIk,  ///< Autodesk's: "LeftUpLeg"; of all names, letters, digits and '_' stay.
  kUnity,    ///< Unity's: "LeftUpperLeg".
};

struct BvhWriteOptions {
  BvhOrder order = BvhOrder::kZxy;
  /// Length of the file's unit: 0.01 writes centimetres, 1 writes metres. [m]
  double unit_m = 0.01;
  BvhNames names = BvhNames::kOwn;
};

/// Whom a file is for. All read all of them: a preset saves settings on import.
enum class BvhDialect {
  kBlender,  ///< Metres; ZYX, which Blender takes for its usual XYZ Euler.
  kMobu,     ///< MotionBuilder: centimetres, ZYX, HumanIK's names.
  kMaya,     ///< As MotionBuilder's: ZYX is Maya's rotate order xyz.
  kUnity,    ///< Metres; YXZ, in which Unity turns; Unity's names.
};

[[nodiscard]] BvhWriteOptions write_options(BvhDialect dialect);

/// "blender", "mobu", "maya" or "unity".
[[nodiscard]] std::string_view name(BvhDialect dialect);
[[nodiscard]] std::optional<BvhDialect> bvh_dialect(std::string_view name);

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
/// the same place in the world. Angles are continuous from frame to frame. Frame Time has
/// all digits of 1 / rate, so that the rate is read again as it was. first_frame is not
/// kept, nor are tips of joints that have children. Every chain has an End Site. No two
/// names are alike.
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
/// Taken as they come: LF, CRLF or CR; tabs and blanks; a byte order mark; names with
/// blanks and colons; position channels of any joint, in any order; numbers with
/// exponents; chains without End Site, and End Sites without OFFSET.
///
/// Joints are at rest as the OFFSETs say, axes parallel to the world's. Position channels
/// replace the OFFSET, as in Blender and MotionBuilder. A root with no OFFSET rests at
/// the height at which the lowest joint or tip stands on the floor. Joints that carry
/// VRM's bone names, and only those, get their `bone`. The rate is rounded to a whole
/// number when Frame Time, which often has few digits, is within 1e-4 of it, else to
/// thousandths or to a 1001st of a whole number of thousands (30000 / 1001) if these are
/// meant to 9 digits.
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
