// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/engine/scene.h"
#include "recordings/base/toml_reader.h"

namespace marey::recordings::stage {

/// Reads [out], with its pictures and VMC ports, and the tables [[measure]] into a scene
/// whose script is read. Mistakes are stored in the document: a key or a range; a key
/// that the kind of figure needs and that is missing, or one that it does not have; an
/// unknown body, target or action; a port that is used twice.
void read_results(TomlReader& root, Scene& scene);

}  // namespace marey::recordings::stage
