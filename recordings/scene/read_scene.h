// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/engine/scene.h"

namespace marey::recordings {

/// Parses the text of a scene (docs/formats/scene.md). `file` is its name in messages.
/// Paths are returned as written. Clips are not looked up: their base is another file.
///
/// Errors (kBadInput), with the line: not TOML; more than 4 MiB; another format; a key
/// that is unknown, missing, of the wrong type or out of range; an id that is used twice;
/// a body, a target or an action that does not exist; groups of different counts that
/// depend on each other; an action that waits for itself or for the end of an action
/// without an end; bodies that depend on each other in the same step, with the cycle.
[[nodiscard]] Result<Scene> parse_scene(std::string_view text, const std::string& file);

/// Applies parse_scene() to the file at `path`. Paths of the base, the floor, bodies,
/// constraints and trials become relative to the working folder instead of the file's
/// folder. Additional error: it cannot be read.
[[nodiscard]] Result<Scene> read_scene(const std::filesystem::path& path);

}  // namespace marey::recordings
