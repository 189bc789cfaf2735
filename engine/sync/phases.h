// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/engine/motion_clip.h"

namespace marey::engine {

/// Feet that bear during a phase of supports.
enum class PhaseClass {
  kNone,  ///< Flight.
  kLeft,  ///< The left foot alone.
  kRight,
  kBoth,
  kAny,  ///< Unknown: a clip without contacts (seated, swimming). Compatible with all.
};

/// A time in which the bearing feet do not change. Times of the clip. [s]
struct Phase {
  PhaseClass feet = PhaseClass::kAny;
  double start_s = 0.0;
  double end_s = 0.0;
};

/// Returns the phases of a clip: ascending, without gaps, from 0 to its duration. A clip
/// without contacts has one phase of kAny. A phase shorter than `min_phase_s` joins the
/// longer one of its neighbours, except at the ends of the clip.
[[nodiscard]] std::vector<Phase> phases_of(const MotionClip& clip,
                                           double min_phase_s = 0.0);

/// Maximum time from an edge at which a flight matches a bearing foot: push-off and
/// landing. [s]
inline constexpr double kFlightEdge_s = 0.10;

/// Whether two phases may be blended at times of their clips. Equal classes may; kBoth
/// with one foot; kNone with one or both feet within kFlightEdge_s of an edge between a
/// flight and a bearing phase in either clip; left with right never.
/// `from_edge_s`: the time to the nearest such edge of either clip.
[[nodiscard]] bool are_compatible(PhaseClass a, PhaseClass b, double from_edge_s);

}  // namespace marey::engine
