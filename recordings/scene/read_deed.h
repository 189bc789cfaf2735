// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "core/engine/scene.h"
#include "recordings/base/toml_reader.h"

namespace marey::recordings::stage {

/// Returns the keys of a deed (an index of SceneDeed), without those of every action.
[[nodiscard]] const std::vector<std::string_view>& deed_keys(std::size_t deed);

/// Reads the keys of a deed from a table of the script. Mistakes are stored in the
/// document: a key that is missing or out of its range, keys that exclude each other, an
/// unknown target.
[[nodiscard]] SceneDeed read_deed(TomlReader& in, std::size_t deed, const Scene& scene);

}  // namespace marey::recordings::stage
