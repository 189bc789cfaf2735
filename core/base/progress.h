// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace marey {

/// Reports the progress of a long operation to its caller: called with `done` <= `total`,
/// `done` never decreasing, from one thread at a time. While the total is not known,
/// `total` is kUnknownTotal; the last call of a successful operation then has `total` ==
/// `done`. May be empty.
using Progress = std::function<void(int done, int total)>;

inline constexpr int kUnknownTotal = 0;

}  // namespace marey
