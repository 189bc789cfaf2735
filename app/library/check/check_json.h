// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/library/check/library_check.h"

namespace marey::app {

/// Returns the result of a check with all clips (docs/formats/library_check.md). Numbers
/// are those of the records.
[[nodiscard]] nlohmann::ordered_json check_json(const LibraryCheck& check);

/// Returns all of check_json() but its list of clips.
[[nodiscard]] nlohmann::ordered_json check_summary_json(const LibraryCheck& check);

}  // namespace marey::app
