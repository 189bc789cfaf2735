// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/motion.h"
#include "retarget/bones/found_bones.h"

namespace marey::retarget {

/// Agreement of a body's bends and direction of travel with the front that follows from
/// its left and right, from -1 (always backwards) to 1. nullopt: too little bend, toe
/// direction or travel to measure.
struct SideEvidence {
  std::optional<double> knees;   ///< Bent knees point forward on a body.
  std::optional<double> toes;    ///< Toes are in front of ankles.
  std::optional<double> walk;    ///< The hips mostly move forward, but not always.
  std::optional<double> elbows;  ///< 1: bent elbows point backward, as they mostly do.
  /// True if arms and legs have their left on the same side.
  std::optional<double> arms_as_legs;
};

/// Computes the evidence from joint positions alone, over all frames. Axes and unit do
/// not matter.
/// Precondition: hips and both legs are found. Cost: linear in frames times joints.
[[nodiscard]] SideEvidence side_evidence(const Motion& motion, const FoundBones& found);

/// The part of the body that has the names of the other side.
enum class ExchangedSides : unsigned char { kNone, kBody, kLegs, kArms };

/// Decides which part is exchanged. Two measures among knees, toes and walk must be
/// backwards, or one and the elbows, and none forwards. So a body that walks backwards,
/// or one with a single wrong joint, is not exchanged.
[[nodiscard]] ExchangedSides exchanged_sides(const SideEvidence& evidence);

}  // namespace marey::retarget
