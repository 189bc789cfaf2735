// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/engine/motion_clip.h"

namespace marey::recordings {

/// Parses the bytes of a base of clips (docs/formats/moves.md). `file` is its name in
/// messages. Linear.
///
/// Errors (kBadInput): another kind of file; a newer version of the format; cut short; a
/// page or blob that differs from its sum; with the clip: another number of bytes than
/// its frames need, and everything that moves_bytes() refuses.
[[nodiscard]] Result<MoveSet> parse_moves(std::string_view bytes,
                                          const std::string& file);

/// Applies parse_moves() to the file at `path`, which is mapped into memory. Errors: also
/// those of MappedFile::open().
[[nodiscard]] Result<MoveSet> read_moves(const std::filesystem::path& path);

}  // namespace marey::recordings
