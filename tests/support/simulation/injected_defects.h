// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "core/base/frame_range.h"
#include "core/motion.h"

namespace marey::testing {

/// Defects of motions, as readers, tools and solvers make them.
enum class Defect {
  kSpike5cm,     ///< One limb turned in one frame: its end is 5 cm off.
  kSpike10cm,    ///< The same by 10 cm.
  kLegsCrossed,  ///< Knees and feet of both legs exchange their places, 10 frames.
  kLegChannels,  ///< Rotations of both legs are exchanged, 10 frames.
  kSlide10cmS,   ///< The body drifts by 10 cm/s over the whole motion.
  kJitter1mm,    ///< Noise of each joint, standard deviation per axis.
  kJitter3mm,
  kFrozenArm,     ///< The rotations of one arm stay the same for 0.5 s.
  kScale110,      ///< Skeleton and path times 1.1: a taller person.
  kPathScale110,  ///< Path of the root alone times 1.1.
  kScale100,      ///< Skeleton and path times 100: centimetres read as metres.
  kFloor3cm,      ///< The body is 3 cm too high.
  kTilt3deg,      ///< The world is tilted by 3 degrees.
  kForearmFlip,   ///< One forearm turned by 180 degrees about a random axis, 3 frames.
  kDoubleRate,    ///< The stated rate is twice the real one.
  kCut300ms,      ///< 0.3 s are missing.
  kMirrored,      ///< The body is mirrored, but its names are not exchanged.
};

inline constexpr int kDefectCount = 17;

/// Returns the defect's name in tables: "spike 5 cm".
[[nodiscard]] std::string_view name(Defect defect);

/// A motion with one defect.
struct InjectedDefect {
  Motion motion;
  FrameRange frames;                             ///< With the defect.
  std::optional<HumanBone> bone = std::nullopt;  ///< Bone of a spike or a flip.
  bool is_local = false;  ///< False: the whole motion has the defect.
};

/// Puts a defect at a place that follows from the seed. nullopt: the motion is shorter
/// than 1.5 s or 20 frames, or lacks a bone that the defect needs.
/// Precondition: the skeleton's arms and legs are marked, and it rests in a T-pose.
[[nodiscard]] std::optional<InjectedDefect> inject(const Motion& clean,
                                                   Defect defect,
                                                   unsigned seed);

}  // namespace marey::testing
