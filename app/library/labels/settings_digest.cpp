// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/labels/settings_digest.h"

#include "app/library/labels/library_labels.h"
#include "recordings/base/sha256.h"
#include "recordings/library/library_paths.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

/// Returns the digest of the tables of labels, with their names.
Result<std::string> labels_digest_of(const fs::path& library) {
  std::string digests;
  const auto tables = label_tables(library);
  if (!tables) return tables.error();
  for (const fs::path& labels : *tables) {
    const auto digest = recordings::sha256_of_file(labels);
    if (!digest) return digest.error();
    digests += labels.filename().string() + *digest;
  }
  return recordings::sha256(digests);
}

}  // namespace

Result<std::string> settings_digest(const fs::path& library,
                                    const LibrarySettings& settings) {
  const auto own =
      recordings::sha256_of_file(recordings::LibraryPaths(library).settings());
  if (!own) return own.error();
  std::string digests = *own;
  for (const LibrarySource& source : settings.sources) {
    if (source.index.empty()) continue;
    // The path stays if it is absolute.
    const auto table = recordings::sha256_of_file(library / source.index);
    if (!table) return table.error();
    digests += *table;
  }
  const auto labels = labels_digest_of(library);
  if (!labels) return labels.error();
  return recordings::sha256(digests + *labels);
}

}  // namespace marey::app
