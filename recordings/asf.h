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

#include "core/motion.h"
#include "core/result.h"
#include "core/skeleton.h"

namespace marey::recordings {

/// One number of a bone in a frame of an AMC: a turn about one of the bone's own axes, a
/// move along one, or the stretch of the bone ("l"), which is read past.
struct AsfChannel {
  enum class Kind { kTurn, kMove, kStretch };
  Kind kind = Kind::kTurn;
  int axis = 0;  ///< 0 X, 1 Y, 2 Z.
};

/// Acclaim's skeleton file.
struct AsfSkeleton {
  /// A joint per bone, at its near end and of its name, below one called "root". Its axes
  /// at rest are parallel to the world's. A bone on which nothing hangs ends in its tip.
  Skeleton skeleton;
  /// Per joint: its numbers in a frame, in their order.
  std::vector<std::vector<AsfChannel>> channels;
  /// Per joint: the axes about which its numbers turn, at rest.
  std::vector<glm::dquat> world_from_axes;
  glm::dvec3 root_place{0.0};  ///< The root's `position`. [m]
  double unit_m = 0.0;         ///< Of lengths in both files.
  bool in_degrees = true;      ///< Angles in an AMC that does not say.
};

struct AsfReadOptions {
  /// Length of the files' unit. Without it, an inch divided by the skeleton's `length`,
  /// as in CMU's database, whose `length 0.45` makes it 56.4 mm. [m]
  std::optional<double> unit_m;
};

struct AmcReadOptions {
  /// The files seldom say how many frames there are in a second. Without this, what the
  /// file says (:SAMPLES-PER-SECOND), or else 120, as in CMU's database.
  std::optional<FrameRate> rate;
};

struct AmcMotion {
  Motion motion;
  bool rate_is_guessed = false;  ///< It is 120 Hz for want of a word.
  /// Bones may be moved off their parents; a Pose moves only the root. The largest such
  /// movement, which was left out.
  double ignored_translation_m = 0.0;
};

/// Reads an Acclaim skeleton (.asf), versions 1.00 and 1.10. `file` is what messages call
/// it.
///
/// World axes are the file's: Y up. A bone's `axis` is as many turns as it has letters,
/// the first one first, about axes that stay where they are; the n-th number belongs to
/// the n-th letter; the root's are its `orientation`. A root without a `position` rests
/// at the height at which the lowest joint or tip stands on the floor. Names stay as they
/// are; joints that carry VRM's bone names, and only those, get their `bone`. Limits,
/// masses, documentation and skins are read past.
///
/// Errors (kBadInput), with the line: not such a file, or cut short; a bone without a
/// name or direction, or there twice; a direction of no length; a unit that is no
/// number above 0; an unknown degree of freedom or order; bones that hang on none, on
/// two, or on themselves; lengths beyond 10 km. Cost: linear in the text.
[[nodiscard]] Result<AsfSkeleton> parse_asf(std::string_view text,
                                            const std::string& file,
                                            const AsfReadOptions& options = {});

/// Reads a motion (.amc) of that skeleton. Frame numbers become frames from 0.
///
/// Errors (kBadInput), with the line: a bone that the skeleton lacks, or that a frame has
/// twice or lacks; another number of values than it has degrees of freedom; what is no
/// number; frames out of order; no frames; a position beyond 10 km; a rate outside 0.1 to
/// 2000 Hz; a motion that does not fit into memory.
/// Cost: linear in the text.
[[nodiscard]] Result<AmcMotion> parse_amc(std::string_view text,
                                          const std::string& file,
                                          const AsfSkeleton& skeleton,
                                          const AmcReadOptions& options = {});

/// parse_asf() of the file at `path`. Errors also as read_file()'s.
[[nodiscard]] Result<AsfSkeleton> read_asf(const std::filesystem::path& path,
                                           const AsfReadOptions& options = {});

/// parse_amc() of the file at `path`. Errors also as read_file()'s.
[[nodiscard]] Result<AmcMotion> read_amc(const std::filesystem::path& path,
                                         const AsfSkeleton& skeleton,
                                         const AmcReadOptions& options = {});

/// The skeleton that goes with a motion, as databases lay them: of the .asf files beside
/// it the one of its name, or of the most of its name before a '_' ("02.asf" for
/// "02_01.amc"), or the only one. nullopt when none is.
[[nodiscard]] std::optional<std::filesystem::path> skeleton_beside(
    const std::filesystem::path& amc);

}  // namespace marey::recordings
