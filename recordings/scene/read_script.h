// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/engine/scene.h"
#include "recordings/base/toml_reader.h"

namespace marey::recordings::stage {

/// Reads the tables [[at]] into a scene whose bodies and targets are read. Mistakes are
/// stored in the document: a key or a range; an id that is used twice; an unknown body,
/// target or action, or an action of other bodies; bodies that cannot be paired with
/// those of the target; actions that wait for each other, or for the end of one that has
/// none; bodies that depend on each other in the same step.
void read_script(TomlReader& root, Scene& scene);

}  // namespace marey::recordings::stage
