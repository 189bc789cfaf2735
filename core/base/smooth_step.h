// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace marey {

/// Rises from 0 to 1 while `x` does, with zero first and second derivatives at both ends;
/// constant outside. All blending in and out uses it and is therefore C2.
[[nodiscard]] inline double smooth_step(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * x * (10.0 + x * (6.0 * x - 15.0));
}

}  // namespace marey
