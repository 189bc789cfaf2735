// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/library/sources/list_sources.h"
#include "app/library/sources/source_motion.h"
#include "core/base/result.h"
#include "core/library/library_settings.h"

namespace marey::app {

struct ReadSourceOptions {
  CleanBy clean = CleanBy::kNone;
  std::optional<double> table_rate_hz;     ///< Rate of the index table for this file.
  std::optional<double> table_duration_s;  ///< Duration that the index table states.
  std::string table_evidence;              ///< IndexEntry::evidence.
  /// Folder for temporary results of a solve; empty: the system's. They are removed.
  std::filesystem::path scratch;
};

/// Numbers equal names of bodies, so that each motion of a source has its own: "Bob" and
/// "Bob (2)". The first one keeps its name.
void number_equal_bodies(std::vector<SourceMotion>& all);

/// Reads all motions of a source, each on its own body, whose names differ: motion files
/// as read_motion(); markers by the steps of `marey repair` and `marey fit`; sessions and
/// takes by those of `marey process`; recipes rendered. The source and its folder are not
/// changed. The result depends on the source's files and the options alone, not on the
/// number of threads. Runs in a forked child process. Errors, with the file: those of the
/// readers and solvers; a rate that is not 0.1 to 2000 Hz; a cleaning that this kind of
/// source does not support.
[[nodiscard]] Result<std::vector<SourceMotion>> read_source(
    const SourceFile& file,
    const LibrarySource& source,
    const ReadSourceOptions& options = {});

}  // namespace marey::app
