// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "app/library/sources/list_sources.h"
#include "app/library/sources/source_kind.h"
#include "app/motion/motion_files.h"
#include "core/motion.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::testing {

/// Returns the source of a path, as list_sources() does.
[[nodiscard]] inline app::SourceFile source_at(const std::filesystem::path& path) {
  app::SourceFile file;
  file.path = path;
  file.name = path.filename().string();
  file.kind = app::source_kind(path);
  return file;
}

/// Writes a walk of 1.5 s at 60 Hz; the extension selects the format. Returns true if it
/// could.
[[nodiscard]] inline bool write_walk(const std::filesystem::path& path,
                                     app::MotionFormat format,
                                     double rise_m = 0.0) {
  Motion motion = synthetic_walk(90, 60.0).motion;
  for (Pose& pose : motion.poses) pose.root_in_world.y += rise_m;
  return app::write_motion_file(path, format, motion, {}).has_value();
}

}  // namespace marey::testing
