// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "core/base/result.h"
#include "core/motion.h"
#include "core/skeleton.h"

namespace marey::recordings {

/// One value of a bone in a frame of an AMC: a rotation about one of the bone's own axes,
/// a translation along one, or the stretch of the bone ("l"), which is ignored.
struct AsfChannel {
  enum class Kind { kTurn, kMove, kStretch };
  Kind kind = Kind::kTurn;
  int axis = 0;  ///< 0 X, 1 Y, 2 Z.
};

/// Content of an Acclaim skeleton file.
struct AsfSkeleton {
  /// One joint per bone, at the bone's proximal end and with its name, below a joint
  /// "root". The joints' axes at rest are parallel to the world's. A bone without
  /// children has a tip.
  Skeleton skeleton;
  /// Per joint: its channels in file order.
  std::vector<std::vector<AsfChannel>> channels;
  /// Per joint: the rest orientation of its rotation axes.
  std::vector<glm::dquat> world_from_axes;
  glm::dvec3 root_place{0.0};  ///< The root's `position`. [m]
  double unit_m = 0.0;         ///< Length unit of both files. [m]
  bool in_degrees = true;      ///< Default unit of angles, for an AMC without one.
};

struct AsfReadOptions {
  /// Length of the files' unit. Default: an inch divided by the skeleton's `length`, as
  /// in CMU's database, where `length 0.45` gives 56.4 mm. [m]
  std::optional<double> unit_m;
};

struct AmcReadOptions {
  /// Frame rate, which the files rarely state. Default: the file's :SAMPLES-PER-SECOND,
  /// else 120, as in CMU's database.
  std::optional<FrameRate> rate;
};

struct AmcMotion {
  Motion motion;
  bool rate_is_guessed = false;  ///< The file states no rate; 120 Hz is assumed.
  /// Largest translation of a bone relative to its parent that was dropped, because a
  /// Pose moves only the root. [m]
  double ignored_translation_m = 0.0;
};

/// Reads an Acclaim skeleton (.asf), versions 1.00 and 1.10. `file` is its name in
/// messages.
///
/// World axes are the file's: Y up. A bone's `axis` consists of one rotation per letter,
/// the first letter applied first, about fixed axes; the n-th number belongs to the n-th
/// letter. The root's axes are its `orientation`. A root without a `position` rests at
/// the height at which the lowest joint or tip is on the floor. Names are unchanged;
/// exactly the joints with VRM's bone names get their `bone`. Limits, masses,
/// documentation and skins are ignored.
///
/// Errors (kBadInput), with the line: not such a file, or incomplete; a bone without a
/// name or direction, or defined twice; a direction of zero length; a unit that is no
/// number above 0; an unknown degree of freedom or order; bones with no parent, with two,
/// or in a cycle; lengths beyond 10 km. Cost: linear in the text.
[[nodiscard]] Result<AsfSkeleton> parse_asf(std::string_view text,
                                            const std::string& file,
                                            const AsfReadOptions& options = {});

/// Reads a motion (.amc) of that skeleton. Frame numbers become frames from 0.
///
/// Errors (kBadInput), with the line: a bone that the skeleton lacks, or that a frame
/// repeats or lacks; a number of values that differs from the bone's degrees of freedom;
/// a value that is no number; frames out of order; no frames; a position beyond 10 km; a
/// rate outside 0.1 to 2000 Hz; a motion that does not fit into memory. Cost: linear in
/// the text.
[[nodiscard]] Result<AmcMotion> parse_amc(std::string_view text,
                                          const std::string& file,
                                          const AsfSkeleton& skeleton,
                                          const AmcReadOptions& options = {});

/// Applies parse_asf() to the file at `path`. Errors: also those of read_file().
[[nodiscard]] Result<AsfSkeleton> read_asf(const std::filesystem::path& path,
                                           const AsfReadOptions& options = {});

/// Applies parse_amc() to the file at `path`. Errors: also those of read_file().
[[nodiscard]] Result<AmcMotion> read_amc(const std::filesystem::path& path,
                                         const AsfSkeleton& skeleton,
                                         const AmcReadOptions& options = {});

/// Finds the skeleton of a motion, following the naming of databases. Returns the .asf
/// file in the same folder with the motion's name, or with the longest prefix of its name
/// before a '_' ("02.asf" for "02_01.amc"), or the only one. nullopt if none matches.
[[nodiscard]] std::optional<std::filesystem::path> find_skeleton_file(
    const std::filesystem::path& amc);

}  // namespace marey::recordings
