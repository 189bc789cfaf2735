// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/bone_map.h"
#include "core/skeleton.h"

namespace marey::recordings {

/// Returns the path of the bone map that applies to a body if it exists next to it:
/// man.bones.toml for man.glb.
[[nodiscard]] std::filesystem::path bone_map_path(const std::filesystem::path& body);

/// Returns the text of a bone map, joints by name. A joint whose name is not unique
/// cannot be identified by name and is omitted.
[[nodiscard]] std::string bone_map_text(const BoneMap& map, const Skeleton& skeleton);

/// Writes bone_map_text(), as a whole or not at all. Errors: those of write_file().
[[nodiscard]] Status write_bone_map(const std::filesystem::path& path,
                                    const BoneMap& map,
                                    const Skeleton& skeleton);

/// Parses the text of a bone map for a skeleton; docs/formats/bodies.md lists its keys.
/// `file` is its name in error messages. Errors (kBadInput), with the line: not TOML; an
/// unknown key or bone, or a joint that the skeleton lacks or has twice, with the nearest
/// known name; one joint for two bones; an invalid unit; "up" or "front" that are no
/// axis, or are parallel.
[[nodiscard]] Result<BoneMap> parse_bone_map(std::string_view text,
                                             const std::string& file,
                                             const Skeleton& skeleton);

/// Applies parse_bone_map() to the file at `path`. Errors: also those of read_file().
[[nodiscard]] Result<BoneMap> read_bone_map(const std::filesystem::path& path,
                                            const Skeleton& skeleton);

}  // namespace marey::recordings
