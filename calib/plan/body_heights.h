// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace marey::calib {

/// A height at which errors are evaluated, relative to the stature: R. Drillis and R.
/// Contini, "Body segment parameters", 1966.
struct BodyHeight {
  const char* name;
  double over_stature;
};
inline constexpr std::array<BodyHeight, 3> kBodyHeights{
    {{"ankle", 0.039}, {"hip", 0.530}, {"shoulder", 0.818}}};
inline constexpr double kTypicalStature_m = 1.75;

}  // namespace marey::calib
