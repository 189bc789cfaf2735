// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "core/base/result.h"
#include "core/engine/motion_clip.h"

namespace marey::recordings {

/// Returns the bytes of a base of clips (docs/formats/moves.md): an SQLite database from
/// which parse_moves() returns the same clips; rotations within 1e-6 rad, other numbers
/// exact. 426 bytes a frame, and some KiB. The same clips give the same bytes.
///
/// Errors (kBadInput), with the clip: a name that is empty, not one line of text or
/// occurs twice; fewer than two frames, or another number of path entries; a number that
/// is not finite or out of range; a rotation that is not of unit length; contacts, tags
/// or notes out of order; a wrong SHA-256; constraints that constraints_text() cannot
/// write. (kDevice): no memory is left. `file` is the name in messages.
[[nodiscard]] Result<std::string> moves_bytes(const MoveSet& moves,
                                              const std::string& file);

/// Writes moves_bytes() to `path`, as a whole or not at all. Errors: also those of
/// write_file().
[[nodiscard]] Status write_moves(const std::filesystem::path& path, const MoveSet& moves);

}  // namespace marey::recordings
