// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/library/clip_record.h"

namespace marey::recordings {

/// State of one clip in a version of a library.
struct VersionLine {
  std::string clip_id;
  std::string object_key;  ///< Key of its motion.
  std::string quality;     ///< "pass", "warn" or "fail".
  std::string labels;      ///< First 16 digits of the SHA-256 of its labels.
  std::string state;       ///< First 16 digits of the SHA-256 of the rest of its record.
  std::string source_id;
  std::string licence;
  std::string name;
};

/// Returns the line of a clip.
[[nodiscard]] VersionLine version_line(const ClipRecord& record);

/// Returns the text of a version: a first line with the format, and one line per clip in
/// ascending order of ids, values separated by tabs. The SHA-256 of this text is the
/// version's name. Same clips, same bytes. Tabs and line ends in values become blanks.
[[nodiscard]] std::string version_text(std::vector<VersionLine> lines);

/// Reads a text of version_text(). Errors (kBadInput), with the line: a line with another
/// number of values; another format.
[[nodiscard]] Result<std::vector<VersionLine>> parse_version(std::string_view text,
                                                             const std::string& file);

/// One file of versions/.
struct LibraryVersion {
  int number = 0;  ///< From 1.
  std::filesystem::path path;
};

/// Lists the versions of a library, ascending. Files with other names are left out.
[[nodiscard]] std::vector<LibraryVersion> list_versions(
    const std::filesystem::path& library);

/// Returns the place of a version: versions/0007.txt.
[[nodiscard]] std::filesystem::path version_path(const std::filesystem::path& library,
                                                 int number);

/// Difference of one clip between two versions.
struct ClipChange {
  std::string clip_id;
  std::string name;
  /// Quality before and after; empty: the clip is not in this version.
  std::string quality_before;
  std::string quality_after;
  bool has_new_source = false;  ///< A clip of the same name has another source.
  bool has_new_motion = false;  ///< The source was processed differently.
  bool has_new_labels = false;
  bool has_new_licence = false;
  bool has_new_name = false;
  bool has_new_state = false;  ///< Split, duplicates, figures or other values.
};

/// Returns the clips that differ, ascending by name, then by id. A clip that went and one
/// that came with the same name are one clip whose source changed. Linear times
/// logarithm. Precondition: both are sorted by id, as parse_version() returns them.
[[nodiscard]] std::vector<ClipChange> compare_versions(
    std::span<const VersionLine> before, std::span<const VersionLine> after);

}  // namespace marey::recordings
