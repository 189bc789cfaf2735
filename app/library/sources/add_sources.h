// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace marey::app {

/// Arguments of `marey library add`, apart from those of the build that follows.
struct AddSourcesArguments {
  std::filesystem::path library;             ///< Folder; created if it does not exist.
  std::vector<std::filesystem::path> paths;  ///< Files and folders, at least one.
  std::string licence;  ///< SPDX expression, "unknown", or a file with the text.
  std::string origin;   ///< Repository, address or person (--source).
  std::string commit;
  std::string attribution;
  std::string kind;  ///< Only files of this kind; empty: all.
  std::optional<double> rate_hz;
  std::filesystem::path index;  ///< Index table; empty: none.
  std::string subject;          ///< Name, or a pattern with {subject}.
  std::string pattern;          ///< Pattern of labels.
  std::vector<std::string> skip;
};

/// Adds a [[source]] for each path to library.toml, which is created if it does not
/// exist. The rest of the file is unchanged, comments included; it is replaced as a whole
/// or not at all. Paths below the library are stored relative to it, others absolute. The
/// sources themselves are not read.
/// Errors (kBadInput): library.toml cannot be read; a path that does not exist, has no
/// file that a library reads, is stated already, or whose files all belong to earlier
/// sources; a licence that spdx_licence() refuses; a rate that is not 0.1 to 2000 Hz; an
/// index table with an error; a pattern that fits no file. (kDevice): the disk.
[[nodiscard]] Status add_sources(const AddSourcesArguments& args);

}  // namespace marey::app
