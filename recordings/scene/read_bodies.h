// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/engine/scene.h"
#include "recordings/base/toml_reader.h"

namespace marey::recordings::stage {

/// Reads the tables [[body]] and [[group]] into a scene. Mistakes are stored in the
/// document: a key, a range, an id that is used twice, also by a member of a group; no
/// body at all, or more than 5000.
void read_bodies(TomlReader& root, Scene& scene);

/// Returns the ids of bodies and groups, for suggestions.
[[nodiscard]] std::vector<std::string> body_names(const Scene& scene);

/// Returns the bodies that the text `key` names; count 0 after a mistake, which is
/// stored: there are none.
[[nodiscard]] SceneMembers read_members(TomlReader& in,
                                        std::string_view key,
                                        const Scene& scene,
                                        std::string& name);

}  // namespace marey::recordings::stage
