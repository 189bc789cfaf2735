// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/library/sources/list_sources.h"
#include "core/base/result.h"

namespace marey::app {

/// Files that a source's motions depend on. If none of `files` changes and none of
/// `absent` appears, the source's id stays the same.
struct SourceParts {
  /// The source itself first, or the session.toml of a session's folder.
  std::vector<std::filesystem::path> files;
  /// Files that a reader would use, but that do not exist: a bone map next to the motion.
  std::vector<std::filesystem::path> absent;
};

struct IdentifiedSource {
  std::string id;  ///< 64 lower-case hexadecimal digits.
  SourceParts parts;
};

/// Returns the id of a source and its files. The id is the SHA-256 of the source's bytes
/// if it is a single file. Otherwise it is the SHA-256 of a text with the role and the
/// SHA-256 of each part: an AMC has its ASF, a glTF its buffers, any motion its bone map
/// (NAME.bones.toml), markers kMarkerSubjectFile and kMarkerMapFile of their folder, a
/// recipe its sources and avatars, a session its videos, tables of frame times and lenses
/// with their paths. It does not depend on the source's own path, on times or on the
/// machine. Malformed content is no error here: its reader reports it.
/// Errors (kBadInput), with the file: a part that cannot be read. Cost: reads every part
/// once; 0.5 s per GB.
[[nodiscard]] Result<IdentifiedSource> identify_source(const SourceFile& source);

}  // namespace marey::app
