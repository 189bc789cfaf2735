// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace marey::app {

/// MAREY_VERSION is the project's version in CMakeLists.txt.
inline constexpr const char* kVersion = MAREY_VERSION;

}  // namespace marey::app
