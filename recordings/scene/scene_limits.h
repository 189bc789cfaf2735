// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "recordings/base/motion_limits.h"
#include "recordings/base/toml_reader.h"

namespace marey::recordings::stage {

// Ranges of the numbers in scenes. They exclude mistakes and overflows; the engine checks
// values against clips and bodies.

inline constexpr Limits kTime{0.0, 1e5, "s"};
inline constexpr Limits kSceneDuration{0.01, 1e5, "s"};
inline constexpr Limits kActionDuration{0.001, 1e5, "s"};
inline constexpr Limits kFade{0.0, 100.0, "s"};
inline constexpr Limits kStepRate{1.0, 1000.0, "Hz"};
inline constexpr Limits kPictureRate{1.0, 1000.0, "Hz"};
inline constexpr Limits kFrequency{0.0, 100.0, "Hz"};
inline constexpr Limits kPlace{-kMaxDistance_m, kMaxDistance_m, "m"};
inline constexpr Limits kLength{0.0, kMaxDistance_m, "m"};
inline constexpr Limits kOffset{-100.0, 100.0, "m"};
inline constexpr Limits kAngle{-36000.0, 36000.0, "degrees"};
inline constexpr Limits kTurn{0.0, 360.0, "degrees"};
inline constexpr Limits kTurnSpeed{0.0, 3600.0, "degrees/s"};
inline constexpr Limits kAzimuth{-180.0, 180.0, "degrees"};
inline constexpr Limits kElevation{-90.0, 90.0, "degrees"};
inline constexpr Limits kStature{0.1, 10.0, "m"};
inline constexpr Limits kMass{0.01, 1000.0, "kg"};
inline constexpr Limits kLoad{0.0, 1000.0, "kg"};
inline constexpr Limits kRatio{0.1, 10.0};
inline constexpr Limits kSpread{0.0, 0.5};
inline constexpr Limits kImportance{0.0, 1e6};
inline constexpr Limits kConstraintImportance{1e-6, 1e6};
inline constexpr Limits kPriority{0.0, 1e6};
inline constexpr Limits kPrecision{1e-6, 1.0, "m"};
inline constexpr Limits kClipRate{0.25, 4.0};
inline constexpr Limits kStepFactor{0.1, 10.0};
inline constexpr Limits kSpeed{0.0, 200.0, "m/s"};
inline constexpr Limits kFollowSpeed{0.001, 200.0, "m/s"};
inline constexpr Limits kDrag{0.0, 10.0, "1/m"};
inline constexpr Limits kGravity{0.5, 30.0, "m/s^2"};
inline constexpr Limits kUnits{0.0, 1e9, "units"};
inline constexpr Limits kCost{1e-3, 1e6, "units"};
inline constexpr Limits kApex{0.01, 100.0, "m"};
inline constexpr Limits kRaise{-100.0, 100.0, "m"};
inline constexpr Limits kAirtime{0.02, 20.0, "s"};
inline constexpr Limits kJumpLength{0.0, 100.0, "m"};
inline constexpr Limits kBox{-20.0, 20.0, "m"};
inline constexpr Limits kValue{-1e9, 1e9};
inline constexpr Limits kSeed{0.0, 2147483647.0};
inline constexpr Limits kLevel{0, 3};
inline constexpr Limits kLayer{0, 7};
inline constexpr Limits kCycles{1, 10000};
inline constexpr Limits kMembers{1, 1000};
inline constexpr Limits kSegmentRange{1, 1e6};
inline constexpr Limits kPixels{16, 8192, "px"};
inline constexpr Limits kPort{1, 65535};
inline constexpr Limits kRepeat{1, 1000};

inline constexpr std::size_t kMaxIdBytes = 100;
inline constexpr std::size_t kMaxNameBytes = 1000;
inline constexpr std::size_t kMaxPathBytes = 4096;
inline constexpr std::size_t kMaxSceneBytes = std::size_t{4} << 20;
inline constexpr std::size_t kMaxBodies = 5000;
inline constexpr std::size_t kMaxTables = 2000;  ///< For targets, actions and so on.
inline constexpr std::size_t kMaxDependencies = 20'000;
inline constexpr std::size_t kMaxThrows = 10'000;

}  // namespace marey::recordings::stage
