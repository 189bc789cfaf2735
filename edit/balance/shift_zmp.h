// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "dynamics/balance/support_polygon.h"
#include "edit/state/edit_state.h"
#include "edit/state/op_weights.h"

#include "core/character.h"
#include "core/motion.h"

namespace marey::edit {

struct ShiftZmpReport {
  dynamics::ZmpFigures before{};  ///< Frames with a weight above 0.
  dynamics::ZmpFigures after{};   ///< The same frames.
  double max_shift_m = 0.0;       ///< Largest horizontal displacement of the root.
  double lowered_m = 0.0;         ///< Largest distance by which the root was lowered.
  double missed_m = 0.0;          ///< Largest distance of a standing foot from its place.
  int missed_frame = 0;
};

/// Moves the root horizontally so that the zero moment point is inside the support area
/// in every loaded frame (dynamics/balance/keep_zmp.h). Standing feet keep their places,
/// and legs follow (hold_feet()); a moved leg changes centre of mass and angular momentum
/// again, so the displacement is computed up to twelve times from the motion as it is
/// then, and the motion with the fewest points outside is kept. Frames with weight 0 keep
/// their pose to the bit. Linear in frames. Preconditions: `motion` is the state's
/// motion; those of zmp_track().
ShiftZmpReport shift_zmp(const EditState& state,
                         std::span<const PointMass> masses,
                         const OpWeights& weights,
                         Motion& motion);

}  // namespace marey::edit
