// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "core/board.h"
#include "recordings/session.h"
#include "recordings/session_family.h"
#include "recordings/toml_reader.h"

// Private to recordings.
namespace marey::recordings {

/// What [board] or [wand] of a session says; its tags are noted as in use. A wand that is
/// a segment of the body has none yet. Mistakes: neither of them, or both; an unknown type,
/// dictionary or family; keys of another type; what does not fit together; a chessboard
/// that does not show which way up it is.
[[nodiscard]] CalibrationTarget read_target(TomlReader& root,
                                            const KnownFamily& usual_family,
                                            Session& session);

/// The tags of the body's segment that [wand] names become the wand's. Does nothing when
/// it names none. Precondition: the session's tags are read. Mistakes: an unknown segment,
/// or one that carries no tag.
void read_wand_segment(TomlReader& root, Session& session);

/// What carries the tag `id` of `family` besides the body: "on the board", "on the wand".
/// nullopt when nothing does.
[[nodiscard]] std::optional<std::string> place_on_target(const CalibrationTarget& target,
                                                         TagId id,
                                                         const KnownFamily& family);

}  // namespace marey::recordings
