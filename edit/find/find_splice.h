// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "edit/find/planar_match.h"
#include "edit/state/edit_state.h"

#include "core/base/frame_range.h"
#include "core/human/contacts.h"

namespace marey::edit {

/// Feet that bear in one frame.
enum class SupportClass { kNone, kLeft, kRight, kBoth };
/// Precondition: the frame is one of the contacts'.
[[nodiscard]] SupportClass support_class(const Contacts& contacts, int frame);
/// Returns true if one frame stands on the left foot alone and the other on the right
/// one.
[[nodiscard]] bool supports_oppose(SupportClass a, SupportClass b);

/// Frames in which the first motion may be left, and the second one entered. A frame that
/// the user gave is a window of one frame.
struct SpliceWindows {
  FrameRange leave;
  FrameRange enter;
};

/// A pair of frames that show the same instant of the joined motion.
struct SpliceCandidate {
  int leave = 0;  ///< In the first motion.
  int enter = 0;  ///< In the second motion.
  PlanarMatch match;
  /// Time in which a foot bears in one motion and swings in the other, of both feet,
  /// within FindSpliceOptions::around_s of the pair. [s]
  double unlike_s = 0.0;
  /// Angle between the directions of both pelvises after the move. [rad]
  double facing_rad = 0.0;
  /// match.distance_m + unlike_m_per_s * unlike_s + facing_m * (1 - cos facing_rad).
  double cost_m = 0.0;
};

struct FindSpliceOptions {
  MatchOptions match;
  double around_s = 0.15;  ///< Half of the time in which contacts are compared.
  /// Cost of unlike contacts: the weights of distances are masses, in which a foot that
  /// stands and one that swings hardly differ. [m/s]
  double unlike_m_per_s = 0.3;
  /// Cost of pelvises that face different directions, at a right angle. The best move of
  /// two windows that travel in opposite directions relative to the body may turn one of
  /// them round. [m]
  double facing_m = 0.4;
  bool align = true;  ///< False: the second motion is not moved, its place counts.
  /// Pairs that stand on opposite feet are accepted.
  bool allow_opposed = false;
  int max_candidates = 5;
  /// Candidates differ by more than this in one of their frames. [s]
  double separation_s = 0.15;
};

/// Returns the best pairs of frames for a transition, by cost: the weighted difference of
/// joints and of their velocities over five frames round each, after the best planar move
/// (Kovar, Gleicher and Pighin, "Motion graphs", 2002; match_windows()), plus a cost of
/// unlike contacts of the feet round them, and of different facing directions. With equal
/// costs the later `leave` comes first. Pairs that stand on opposite feet are left out;
/// the result is empty if there are no others. Windows with more than 40 000 pairs are
/// searched on a grid, whose best places are then searched frame by frame. Cost: some
/// microseconds per pair.
/// Precondition: both states have the same skeleton and rate; the windows are within the
/// motions and not empty.
[[nodiscard]] std::vector<SpliceCandidate> find_splices(
    const EditState& first,
    const EditState& second,
    const SpliceWindows& windows,
    const FindSpliceOptions& options = {});

}  // namespace marey::edit
