// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/find/planar_match.h"
#include "edit/ops/cycle_constraints.h"
#include "edit/ops/periodic_channel.h"
#include "edit/state/edit_state.h"
#include "edit/state/plant_feet.h"

#include "core/edit/edit_ops.h"

namespace marey::edit {

/// One cycle of a motion, in frames of the motion, with fractions.
struct CycleSpec {
  double first = 0.0;
  double period_frames = 0.0;
  PlanarMove travel;  ///< Moves the posture at `first` to the one a period later.
  CycleDrift drift = CycleDrift::kStraight;
  double blend_s = 0.1;  ///< Before and after the seam; see make_periodic().
};

/// A cycle that repeats exactly. Frame k + frames is frame k moved by `step`; the last
/// frame is the one before the repetition.
struct ClosedCycle {
  /// One cycle at the motion's rate, with contacts, annotations, uncertainty and lineage
  /// of the source, and its constraints moved with it (carry_constraints()).
  /// CycleDrift::kNone: the root stays in place.
  EditState cycle;
  PlanarMove step;  ///< Identity for CycleDrift::kNone.
  /// The source's postures of the same frames, moved rigidly frame by frame onto the
  /// path of the result.
  Motion source;
  /// Three cycles with planted feet, before the root is put in place: `cycle` is the
  /// middle one, and `travel` moves each to the next.
  Motion three;
  /// Contacts of the cycle, also where `cycle` has none.
  Contacts contacts;
  PlanarMove travel;
  double travel_m = 0.0;  ///< Distance that the hips travel in one cycle.
  PlantReport plant;
  DroppedConstraints dropped;  ///< Constraints outside of the cycle.
};

/// Returns the number of whole frames nearest to the period: at least 2.
[[nodiscard]] int cycle_frames(const CycleSpec& spec);

/// Makes a part of a motion periodic.
///
/// The cycle is sampled at cycle_frames() instants, equally spaced over the period. So
/// the rate stays, and the period changes by half a frame at most.
///
/// Travel and turn are spread evenly: the motion is described in a frame that moves by
/// `travel` over the period at constant speed and turn (a screw about the vertical).
/// There the root, the rotation of each joint in its parent and the places of both feet
/// are made periodic (make_periodic()). Then the motion is put back on a path by `drift`:
/// the same screw; a straight line of the same length along the travel of the whole
/// cycle; or no path. In the middle of the cycle the body keeps its place and direction.
///
/// Each footprint moves as a whole, with the path at the middle of its stance; a foot
/// that swings goes from one to the next. Legs follow the feet, and plant_feet() gives
/// every stance of three consecutive cycles one footprint. So the footprints of a cycle
/// are those of the one before it moved by `travel`. The contacts are the source's.
///
/// In place (CycleDrift::kNone) standing feet move backwards with the floor: the cycle
/// has no contacts, so that no later operation plants them. Linear in frames.
/// Precondition: 0 <= first, period_frames >= 2, first + period_frames <= frames - 1.
[[nodiscard]] ClosedCycle close_cycle(const EditState& state, const CycleSpec& spec);

/// Returns the contacts of `count` copies of a cycle: runs that reach a seam continue on
/// its other side.
[[nodiscard]] Contacts repeat_contacts(const Contacts& contacts, int count);

}  // namespace marey::edit
