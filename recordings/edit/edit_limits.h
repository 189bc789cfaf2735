// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "recordings/base/motion_limits.h"
#include "recordings/base/toml_reader.h"

namespace marey::recordings::recipe {

// Ranges of the numbers in recipes. They exclude mistakes and overflows; whether a value
// suits a motion is decided where the motion is known.

inline constexpr Limits kTime{0.0, 1e6, "s"};
inline constexpr Limits kFrame{0.0, 1e9, "frames"};
inline constexpr Limits kFade{0.0, 1e3, "s"};
inline constexpr Limits kFrequency{0.01, 1000.0, "Hz"};
inline constexpr Limits kBand{0.0, 1000.0, "Hz"};
inline constexpr Limits kRate{kMinRateHz, kMaxRateHz, "Hz"};
inline constexpr Limits kDuration{1e-3, 1e6, "s"};
inline constexpr Limits kSpeed{0.01, 100.0};
inline constexpr Limits kPlace{-kMaxDistance_m, kMaxDistance_m, "m"};
inline constexpr Limits kLength{0.0, kMaxDistance_m, "m"};
inline constexpr Limits kFactor{0.01, 100.0};
inline constexpr Limits kGain{-100.0, 100.0};
inline constexpr Limits kTurn{-36000.0, 36000.0, "degrees"};
inline constexpr Limits kRotation{-360.0, 360.0, "degrees"};
inline constexpr Limits kQuaternion{-1.001, 1.001};
inline constexpr Limits kOrder{2, 3};
inline constexpr Limits kCycles{1, 10000};
inline constexpr Limits kJumpNumber{1, 10000};
inline constexpr Limits kJumpApex{0.01, 100.0, "m"};
inline constexpr Limits kJumpRaise{-100.0, 100.0, "m"};
inline constexpr Limits kJumpAirtime{0.02, 20.0, "s"};
inline constexpr Limits kJumpLength{0.0, 100.0, "m"};
inline constexpr Limits kJumpBox{-20.0, 20.0, "m"};
inline constexpr Limits kJumpPush{0.05, 10.0, "s"};
inline constexpr Limits kStrength{0.5, 100.0, "g"};
inline constexpr Limits kGravity{0.5, 30.0, "m/s^2"};
inline constexpr Limits kShareOfPush{0.001, 0.999};
inline constexpr Limits kValue{-1e9, 1e9};
inline constexpr Limits kImportance{1e-6, 1e6};
inline constexpr Limits kSegmentRange{1, 1e6};
inline constexpr Limits kFigure{0.0, 1e6};

inline constexpr std::size_t kMaxNameBytes = 1000;
inline constexpr std::size_t kMaxPathBytes = 4096;
inline constexpr std::size_t kMaxOps = 10'000;
inline constexpr std::size_t kMaxRecipeBytes = std::size_t{16} << 20;
inline constexpr int kMaxOccurrence = 1'000'000;

}  // namespace marey::recordings::recipe
