// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/build/failed_sources.h"

#include <filesystem>
#include <set>
#include <string>
#include <system_error>

#include "core/base/printable.h"
#include "recordings/base/atomic_file.h"
#include "recordings/library/library_paths.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

/// Returns the place of a source's file below failed/. Sources outside the library have
/// absolute names.
fs::path failed_file(const BuildInputs& inputs, const std::string& name) {
  const fs::path below = fs::path(name).relative_path();
  return recordings::LibraryPaths(inputs.library).failed() / (below.string() + ".txt");
}

std::string failed_text(const Error& error) {
  return printable(error.where) + "\nCause: " + printable(error.cause) +
         ".\nNext: " + printable(error.next) + ".\n";
}

}  // namespace

Status write_failed_sources(const BuildInputs& inputs,
                            const std::vector<SourceOutcome>& outcomes) {
  const fs::path folder = recordings::LibraryPaths(inputs.library).failed();
  std::set<fs::path> current;
  for (const SourceOutcome& outcome : outcomes) {
    if (!outcome.failure) continue;
    const fs::path file = failed_file(inputs, outcome.name);
    const Status ok = recordings::write_file(file, failed_text(*outcome.failure));
    if (!ok) return ok;
    current.insert(file);
  }
  std::error_code failed;
  std::vector<fs::path> old;
  for (fs::recursive_directory_iterator at(folder, failed), end; !failed && at != end;
       at.increment(failed)) {
    std::error_code unknown;
    const bool is_old = at->is_regular_file(unknown) && !current.contains(at->path());
    if (is_old) old.push_back(at->path());
  }
  for (const fs::path& file : old) fs::remove(file, failed);
  if (current.empty()) fs::remove_all(folder, failed);
  return Done{};
}

}  // namespace marey::app
