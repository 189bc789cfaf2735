// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tests/support/truth/body_judge.h"

namespace marey::testing {

/// Fills in the figures of feet: BodyFigures::foot_yaw_deg and what goes with it.
/// Precondition: `heading_deg` of `out` is known; as many frames, at `hz`.
void compare_feet(const std::vector<Landmarks>& source,
                  const std::vector<Landmarks>& body,
                  double hz,
                  BodyFigures& out);

}  // namespace marey::testing
