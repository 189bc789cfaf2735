// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace marey::app {

/// Returns the folder of the sample session: share/marey/samples/first-light next to the
/// bin/ of the running program if it exists, as in an installed tree; else that of the
/// source tree from which the program was built.
[[nodiscard]] std::filesystem::path sample_session();

}  // namespace marey::app
