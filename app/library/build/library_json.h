// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "app/library/build/build_library.h"

namespace marey::app {

/// Returns the result of a build for programs (docs/formats/library.md).
[[nodiscard]] nlohmann::ordered_json library_json(const BuiltLibrary& built);

/// Returns the sentence that ends a build: "version 3: 999 clips, 1.22 h; 12 warned, 3
/// failed".
[[nodiscard]] std::string library_sentence(const BuiltLibrary& built);

}  // namespace marey::app
