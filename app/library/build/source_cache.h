// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/library/sources/list_sources.h"
#include "app/library/sources/source_id.h"
#include "core/base/result.h"
#include "recordings/library/file_stat.h"

namespace marey::app {

/// An identified source, and the states of its files at that time.
struct KnownSource {
  std::string id;
  std::vector<std::pair<std::string, recordings::FileStat>> files;
  std::vector<std::string> absent;  ///< SourceParts::absent.

  /// Returns true if no file changed, vanished or appeared since. Cost: a stat per file.
  [[nodiscard]] bool is_current() const;
};

/// Identifies a source, and records the states of its files. Errors: those of
/// identify_source(); changed_while_read().
[[nodiscard]] Result<KnownSource> know_source(const SourceFile& file);

/// Returns the error of a source that another program changes.
[[nodiscard]] Error changed_while_read(const SourceFile& file);

/// Returns a known source as one line of JSON.
[[nodiscard]] std::string known_source_text(const KnownSource& source);
/// Reads a text of known_source_text(). nullopt: it is damaged.
[[nodiscard]] std::optional<KnownSource> parse_known_source(std::string_view text);

/// Ids of sources by their paths, so that a build reads changed sources only. A local
/// file, which may be deleted at any time.
class SourceCache {
 public:
  /// Reads the cache of a library. A missing or damaged one is empty.
  [[nodiscard]] static SourceCache read(const std::filesystem::path& library);

  /// Returns the source at `path` if none of its files changed since it was added.
  [[nodiscard]] const KnownSource* find(const std::filesystem::path& path) const;
  /// Adds a source. One whose files changed less than 2 s ago is left out: it could
  /// change again without a difference in its state.
  void add(const std::filesystem::path& path, KnownSource source);
  /// Writes the cache of the sources that were added or found since it was read.
  [[nodiscard]] Status write(const std::filesystem::path& library) const;

 private:
  std::map<std::string, KnownSource> sources_;
  mutable std::map<std::string, const KnownSource*> used_;
};

}  // namespace marey::app
