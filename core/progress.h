// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace marey {

/// How a long verb tells its caller where it is: called with `done` <= `total`, `done`
/// never falling, from one thread at a time. While nobody knows how much there is,
/// `total` is kUnknownTotal; then the last call of a verb that succeeds has `total` ==
/// `done`. May be empty.
using Progress = std::function<void(int done, int total)>;

inline constexpr int kUnknownTotal = 0;

}  // namespace marey
