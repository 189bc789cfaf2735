// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "app/library/build/build_inputs.h"
#include "app/library/build/source_outcome.h"
#include "core/base/result.h"
#include "core/library/clip_record.h"

namespace marey::app {

/// Counts of a library, for messages.
struct LibraryCounts {
  std::size_t clips = 0;
  std::size_t warned = 0;
  std::size_t failed = 0;
  std::size_t duplicates = 0;
  double seconds = 0.0;
};

struct MergedLibrary {
  int version = 0;           ///< Number of the current version.
  std::string version_name;  ///< Its SHA-256.
  bool is_new_version = false;
  bool was_current = false;  ///< Nothing changed, and nothing was written.
  LibraryCounts counts;
  std::vector<std::string> remarks;
};

/// Makes index, rows for searches and version of a library from the objects of its
/// sources. It is the only writer of these files. Readers see the version before or the
/// new one: the index is written last, and names the folder of its rows.
/// `sources` and `outcomes` belong together, in ascending order of names.
/// Errors: (kBadInput) `damaged` objects, which are removed: import their sources again;
/// (kDevice) the disk.
[[nodiscard]] Result<MergedLibrary> merge_library(
    const BuildInputs& inputs,
    const std::vector<SourceFile>& sources,
    const std::vector<SourceOutcome>& outcomes,
    std::vector<std::size_t>& damaged);

}  // namespace marey::app
