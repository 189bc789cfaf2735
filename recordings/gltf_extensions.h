// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to recordings: which glTF extensions a file may require.

#include "core/result.h"
#include "recordings/gltf_model.h"

namespace marey::recordings {

/// Declines a file that requires an extension which marey does not read, by the
/// extension's name and with the next step (kBadInput). Extensions of materials and
/// textures change nothing that marey reads.
[[nodiscard]] Status check_extensions(const NamedModel& file);

}  // namespace marey::recordings
