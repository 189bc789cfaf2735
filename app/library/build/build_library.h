// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "app/library/build/build_inputs.h"
#include "app/library/build/merge_library.h"
#include "app/library/build/source_outcome.h"
#include "app/shell/console.h"
#include "core/base/result.h"

namespace marey::app {

/// Result of a build, for people and programs.
struct BuiltLibrary {
  MergedLibrary merged;
  std::size_t sources = 0;
  std::size_t read = 0;         ///< Sources that this build read.
  std::vector<Error> failures;  ///< Sources that gave nothing, by name.
  /// Remarks of readers and of the merge. A remark on several sources occurs once, with
  /// their number and the first one.
  std::vector<std::string> remarks;
};

/// Use of the cache of sources.
enum class CacheUse {
  kReplace,  ///< The given sources are all of the library's.
  kRead,     ///< Only some are given, or other hosts work on the others.
};

/// Returns the names of sources, in order: for name_label_sources().
[[nodiscard]] std::vector<std::string> source_names(
    const std::vector<SourceFile>& sources);

/// Makes the objects of sources in child processes. Returns the outcomes, in the order of
/// the sources; nullopt: the user stopped it. With a cache, sources that have not changed
/// are not read. Outcomes do not depend on `jobs`.
[[nodiscard]] std::optional<std::vector<SourceOutcome>> import_sources(
    const BuildInputs& inputs,
    const std::vector<SourceFile>& sources,
    int jobs,
    CacheUse use,
    Console& console);

/// Imports all sources and merges them. Damaged objects are made again. Errors: the
/// inputs'; those of merge_library(); the user stopped it.
/// Precondition: this process holds the library's lock.
[[nodiscard]] Result<BuiltLibrary> build_library(BuildInputs inputs,
                                                 int jobs,
                                                 Console& console);

/// Merges outcomes, and makes damaged objects again. Errors: also that of an outcome
/// that the machine caused. Precondition: as build_library().
[[nodiscard]] Result<BuiltLibrary> finish_library(const BuildInputs& inputs,
                                                  const std::vector<SourceFile>& sources,
                                                  std::vector<SourceOutcome> outcomes,
                                                  Console& console);

}  // namespace marey::app
