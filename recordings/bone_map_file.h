// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/bone_map.h"
#include "core/result.h"
#include "core/skeleton.h"

namespace marey::recordings {

/// The bone map that counts for a body when it stands beside it: man.glb has
/// man.bones.toml.
[[nodiscard]] std::filesystem::path bone_map_beside(const std::filesystem::path& body);

/// The text of a bone map, joints by name. Where a joint's name is not the only one of
/// its kind it cannot be told by name, and is left out.
[[nodiscard]] std::string bone_map_text(const BoneMap& map, const Skeleton& skeleton);

/// Writes bone_map_text(), replacing the file at once or not at all. Errors as
/// write_file()'s.
[[nodiscard]] Status write_bone_map(const std::filesystem::path& path,
                                    const BoneMap& map,
                                    const Skeleton& skeleton);

/// Reads the text of a bone map for a skeleton; docs/formats.md has its keys. `file` is
/// what error messages call it.
/// Errors (kBadInput), with the line: not TOML; an unknown key or bone, or a joint that
/// the skeleton has not or has twice, with the nearest that there is; one joint for two
/// bones; a unit of no use; "up" or "front" that are no axis, or along each other.
[[nodiscard]] Result<BoneMap> parse_bone_map(std::string_view text,
                                             const std::string& file,
                                             const Skeleton& skeleton);

/// parse_bone_map() of the file at `path`. Errors also as read_file()'s.
[[nodiscard]] Result<BoneMap> read_bone_map(const std::filesystem::path& path,
                                            const Skeleton& skeleton);

}  // namespace marey::recordings
