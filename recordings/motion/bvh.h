// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/motion.h"

namespace marey::recordings {

/// Order of the rotation channels: kZxy writes "Zrotation Xrotation Yrotation", which
/// means R = Rz * Rx * Ry.
enum class BvhOrder {
  kZxy,  ///< The most common order.
  kZyx,  ///< Used by MotionBuilder and LaFAN1.
  kXyz,
  kXzy,
  kYxz,
  kYzx,
};

/// Names of the joints that are human bones.
enum class BvhNames {
  kOwn,  ///< The joints' own names; blanks become '_'.
  /// Autodesk's names: "LeftUpLeg". All names keep only letters, digits and '_'.
  kHumanIk,
  kUnity,  ///< Unity's: "LeftUpperLeg".
};

struct BvhWriteOptions {
  BvhOrder order = BvhOrder::kZxy;
  /// Length of the file's unit: 0.01 writes centimetres, 1 writes metres. [m]
  double unit_m = 0.01;
  BvhNames names = BvhNames::kOwn;
};

/// Target program of a file. Every program reads every dialect; a matching one needs no
/// import settings.
enum class BvhDialect {
  kBlender,  ///< Metres; ZYX, which Blender imports as its default XYZ Euler.
  kMobu,     ///< MotionBuilder: centimetres, ZYX, HumanIK's names.
  kMaya,     ///< As kMobu: ZYX is Maya's rotate order xyz.
  kUnity,    ///< Metres; YXZ, Unity's rotation order; Unity's names.
};

[[nodiscard]] BvhWriteOptions write_options(BvhDialect dialect);

/// Returns "blender", "mobu", "maya" or "unity".
[[nodiscard]] std::string_view name(BvhDialect dialect);
[[nodiscard]] std::optional<BvhDialect> bvh_dialect(std::string_view name);

struct BvhReadOptions {
  /// Length of the file's unit, which the format does not state. [m]
  double unit_m = 0.01;
};

/// Content of a BVH file, as far as a Motion can represent it.
struct BvhMotion {
  Motion motion;
  /// Largest dropped movement of a joint relative to its parent. BVH can move every
  /// joint, a Pose only the root. Movement of the first joint that branches (the hips,
  /// below a helper root) is transferred to the root exactly and is not counted. [m]
  double ignored_translation_m = 0.0;
};

/// Returns the BVH text of a motion, six decimals, Y up. The zero pose is the skeleton's
/// rest pose. The root's position is entirely in its channels (OFFSET 0 0 0), because
/// readers disagree on whether a root's OFFSET counts. A skeleton whose rest rotations
/// are not identity is written with joint axes parallel to the world's; every joint keeps
/// its world position. Angles are continuous from frame to frame. Frame Time has all
/// digits of 1 / rate, so that the rate is read back exactly. first_frame and the tips of
/// joints with children are not stored. Every chain has an End Site. Names are unique.
/// Preconditions: one root, which is the first joint; every pose has one rotation per
/// joint; unit_m > 0.
[[nodiscard]] std::string bvh_text(const Motion& motion,
                                   const BvhWriteOptions& options = {});

/// Writes bvh_text() to `path`, as a whole or not at all. Errors: those of write_file().
[[nodiscard]] Status write_bvh(const std::filesystem::path& path,
                               const Motion& motion,
                               const BvhWriteOptions& options = {});

/// Reads a BVH text: any order and number of channels per joint, any case of keywords.
/// `file` is its name in error messages.
///
/// Accepts LF, CRLF or CR; tabs and blanks; a byte order mark; names with blanks and
/// colons; position channels of any joint, in any order; numbers with exponents; chains
/// without End Site, and End Sites without OFFSET.
///
/// The rest pose is given by the OFFSETs, with axes parallel to the world's. Position
/// channels replace the OFFSET, as in Blender and MotionBuilder. A root with no OFFSET
/// rests at the height at which the lowest joint or tip is on the floor. Exactly the
/// joints with VRM's bone names get their `bone`. Frame Time often has few digits. The
/// rate is therefore rounded to a whole number within 1e-4, else to thousandths or to a
/// 1001st of a whole number of thousands (30000 / 1001) if Frame Time matches it to 9
/// digits.
///
/// Errors (kBadInput), with the line: not a BVH file, or an incomplete one; a second
/// ROOT; a joint with the same bone or with CHANNELS twice; an unknown channel; a row
/// with another number of values, or with a value that is no number; more frames than
/// announced; an OFFSET or a position beyond 10 km; a rate outside 0.1 to 2000 Hz. Cost:
/// linear in the text, about 50 MB/s.
[[nodiscard]] Result<BvhMotion> parse_bvh(std::string_view text,
                                          const std::string& file,
                                          const BvhReadOptions& options = {});

/// Applies parse_bvh() to the file at `path`. Errors: also those of read_file().
[[nodiscard]] Result<BvhMotion> read_bvh(const std::filesystem::path& path,
                                         const BvhReadOptions& options = {});

}  // namespace marey::recordings
