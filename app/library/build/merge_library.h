// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "app/library/build/build_inputs.h"
#include "app/library/build/source_outcome.h"
#include "core/base/result.h"
#include "recordings/library/index_head.h"

namespace marey::app {

struct MergedLibrary {
  recordings::IndexHead head;  ///< Head of the index.
  bool is_new_version = false;
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
