// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

namespace marey {

/// Factors between radians and degrees. Angles are in radians in memory; degrees appear
/// on the command line, in messages and in file formats that require them.
inline constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;
inline constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;

}  // namespace marey
