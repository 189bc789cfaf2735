// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "app/motion/motion_files.h"
#include "core/base/result.h"
#include "core/humanoid.h"
#include "core/motion.h"

namespace marey::app {

/// A file written by write_motion_file().
struct WrittenFile {
  std::filesystem::path path;
  MotionFormat format = MotionFormat::kGlb;
  /// Length of one unit of a .glb or .bvh. [m]
  double unit_m = 1.0;
};

/// Describes the file that write_motion_file() writes with these arguments.
[[nodiscard]] WrittenFile written_file(const std::filesystem::path& out,
                                       MotionFormat format,
                                       const BodyLook& look,
                                       const MotionFileOptions& options = {});

/// Differences between a file that was read again and the motion that was written.
struct RereadFigures {
  /// Largest distance between a bone's joint and its position in the motion. It covers
  /// errors of heading, facing direction, unit and posture. [m]
  double worst_place_m = 0.0;
  HumanBone worst_bone{};
  std::optional<int> worst_frame{};  ///< nullopt: no joint was compared.
  /// For a .vrma: largest distance that the format cannot store. Joints that are no bones
  /// of VRM move the bones below them relative to those above. Not included in
  /// worst_place_m. [m]
  double lost_m = 0.0;
  HumanBone lost_bone{};
  std::optional<int> lost_frame{};
  /// World Y of the lowest vertex of the deformed skin in each frame [m]; empty: this
  /// kind of file has no skin.
  std::vector<double> lowest_skin_m;
};

/// Reads a written file again and compares each bone's world position with the nearest
/// joint of the file. Returns nullopt for .csv and .mot, which contain no joints, and for
/// .glb and .vrma of motions slower than 10 Hz whose rate does not divide 30 Hz.
/// Cost: the reader's; for a .glb also linear in frames times vertices.
/// Errors: the readers'; a number of frames that differs from the motion's.
[[nodiscard]] Result<std::optional<RereadFigures>> reread_motion(const WrittenFile& file,
                                                                 const Motion& motion);

}  // namespace marey::app
