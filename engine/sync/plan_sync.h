// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "engine/sync/phases.h"
#include "engine/sync/sync_side.h"

#include "core/time_warp.h"

namespace marey::engine {

struct SyncOptions {
  double horizon_s = 1.2;
  int max_phases = 8;
  double incompatible_cost_per_s = 10.0;
  double min_rate = 0.5;  ///< Minimum rate of the follower, relative to its speed.
  double max_rate = 2.0;
  /// For a follower that has not begun: it may enter the clip this much later or earlier
  /// than at now_s; a clip that loops may be entered anywhere. 0: it has begun.
  double entry_s = 0.0;
};

/// Maximum number of knots of a plan.
inline constexpr std::size_t kMaxSyncKnots = 12;

/// Times of the follower matched to times of the lead.
struct SyncPlan {
  /// Knots from now on. WarpKnot::time_s is the time from now [s]; WarpKnot::source_s the
  /// unwrapped time of the follower's clip (it exceeds the duration of a clip that
  /// loops). The first knot is at time 0, at the entry.
  std::array<WarpKnot, kMaxSyncKnots> knots{};
  std::size_t knot_count = 0;
  double incompatible_s = 0.0;  ///< Within the horizon, if the plan is followed.
  double worst_rate = 1.0;      ///< The one farthest from 1, by ratio.
  double cost = 0.0;
  /// No matching is better than rate 1: the knots are those of rate 1 (at the entry that
  /// costs least), and a crossfade would meet incompatible supports.
  bool only_inertial = false;

  [[nodiscard]] std::span<const WarpKnot> used() const {
    return {knots.data(), knot_count};
  }
};

/// Plans the times of a follower so that its supports match the lead's (after Menardais,
/// Kulpa, Multon, Arnaldi 2004, "Synchronization for dynamic blending of motions", in
/// spirit; dynamic programming over the next phases of both). Cost of matching phase i to
/// phase j: T (ln rate)^2 + incompatible_cost_per_s times the incompatible time. Between
/// two matches, at most three edges of each side are skipped; after the last match the
/// follower has its own speed. Always has an answer. Same input, same bytes; allocates
/// nothing; some ten microseconds. Precondition: speeds > 0; phases as by phases_of(), at
/// least one; 0 < min_rate <= 1 <= max_rate.
[[nodiscard]] SyncPlan plan_sync(const SyncSide& lead,
                                 const SyncSide& follower,
                                 const SyncOptions& options = {});

/// Returns the time within the next `horizon_s` in which both, at these speeds and from
/// their places now, are incompatible. [s]
[[nodiscard]] double incompatible_time_s(const SyncSide& lead,
                                         const SyncSide& follower,
                                         double horizon_s);

}  // namespace marey::engine
