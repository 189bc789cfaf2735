// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to recordings: check of the extensions that a glTF file requires.

#include "core/base/result.h"
#include "recordings/gltf/gltf_model.h"

namespace marey::recordings {

/// Returns an error (kBadInput), with the extension's name and the next step, if the file
/// requires an extension that marey does not read. Extensions of materials and textures
/// do not affect the data that marey reads.
[[nodiscard]] Status check_extensions(const NamedModel& file);

}  // namespace marey::recordings
