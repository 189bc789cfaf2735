// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/engine/scene.h"
#include "recordings/base/toml_reader.h"

namespace marey::recordings::stage {

/// Reads the tables [[target]] into a scene whose bodies are read. Mistakes are stored in
/// the document: a key, a range, an id that is used twice, an unknown body.
void read_targets(TomlReader& root, Scene& scene);

/// Reads the id of a target. Mistake: no such target, or no name.
[[nodiscard]] std::string read_target_id(TomlReader& in,
                                         std::string_view key,
                                         const Scene& scene);

}  // namespace marey::recordings::stage
