// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace marey::testing {

/// Returns the number of calls of operator new in this program so far, on any thread.
/// Link count_allocations.cpp, which replaces it.
[[nodiscard]] long allocations();

}  // namespace marey::testing
