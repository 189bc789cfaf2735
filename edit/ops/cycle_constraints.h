// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "edit/find/planar_match.h"
#include "edit/state/edit_state.h"

#include "core/constraint.h"

namespace marey::edit {

/// Numbers of constraints that a loop cannot have.
struct DroppedConstraints {
  /// Never fully active within the cycle, or a distance to such a constraint.
  int outside = 0;
  int in_place = 0;  ///< At a place of the world that the body, kept in place, leaves.
};

/// Moves the constraints of a cycle to where the cycle is. Constraints that are never
/// fully active in it are removed.
///
/// A constraint moves as a whole, by the move of the frame in the middle of the time in
/// which it is fully active within the cycle. The place of a DistanceToPoint then follows
/// its point's own displacement at that frame, so that a constraint that was met is met.
/// A support moves from the place that detection finds for its foot in the source
/// (found_supports()) to that in the cycle; supports that share a footprint share it
/// afterwards.
///
/// `moves` has a move per frame from the source to the result, and `moved` the source's
/// postures after these moves. Frames of `cycle` are the result's; its constraints are
/// those of `source`, with times since its first frame. `in_place`: the body does not
/// travel, although the source does. Then constraints with a place in the world are
/// removed, too. Linear in constraints times joints, quadratic in supports.
/// Precondition: one move and one posture per frame of the cycle.
DroppedConstraints carry_constraints(const EditState& source,
                                     std::span<const PlanarMove> moves,
                                     const Motion& moved,
                                     bool in_place,
                                     EditState& cycle);

}  // namespace marey::edit
