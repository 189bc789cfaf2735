// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/motion.h"
#include "retarget/identify_bones.h"

namespace marey::retarget {

/// Which way a body bends and goes against the front that its left and right give, from
/// -1 (always backwards) to 1; nullopt: it hardly bends, points or goes anywhere.
struct SideEvidence {
  std::optional<double> knees;   ///< Bent knees point forward on a body.
  std::optional<double> toes;    ///< Toes lie before ankles.
  std::optional<double> walk;    ///< The hips go forward mostly, and need not.
  std::optional<double> elbows;  ///< Bent elbows point backward (1) mostly.
  /// Whether arms and legs have their left on the same side.
  std::optional<double> arms_as_legs;
};

/// Measures it by the places of joints alone, over all frames; any axes and unit.
/// Precondition: hips and both legs are found. Cost: linear in frames times joints.
[[nodiscard]] SideEvidence side_evidence(const Motion& motion, const FoundBones& found);

/// What bears the names of the other side.
enum class ExchangedSides : unsigned char { kNone, kBody, kLegs, kArms };

/// Decides: of knees, toes and walk two must be backwards, or one and the elbows, and
/// none forwards. A body that walks backwards, or has one joint mistaken, is not exchanged.
[[nodiscard]] ExchangedSides exchanged_sides(const SideEvidence& evidence);

}  // namespace marey::retarget
