// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "core/board.h"
#include "recordings/base/toml_reader.h"
#include "recordings/session/session.h"
#include "recordings/session/session_family.h"

// Private to recordings.
namespace marey::recordings {

/// Reads [board] or [wand] of a session and marks its tags as in use. A wand that is a
/// segment of the body has none yet. Mistakes: neither or both tables; an unknown type,
/// dictionary or family; keys of another type; inconsistent values; a chessboard with
/// ambiguous orientation.
[[nodiscard]] CalibrationTarget read_target(TomlReader& root,
                                            const KnownFamily& default_family,
                                            Session& session);

/// Moves the tags of the body segment that [wand] names to the wand. Does nothing if it
/// names none. Precondition: the session's tags are read. Mistakes: an unknown segment,
/// or one without tags.
void read_wand_segment(TomlReader& root, Session& session);

/// Returns the object other than the body that carries the tag `id` of `family`: "on the
/// board", "on the wand". nullopt if there is none.
[[nodiscard]] std::optional<std::string> place_on_target(const CalibrationTarget& target,
                                                         TagId id,
                                                         const KnownFamily& family);

}  // namespace marey::recordings
