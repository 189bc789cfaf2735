// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "benchmarks/engine/transition_judge.h"

namespace marey {

/// Transitions of other engines, implemented as published.
enum class RivalMethod {
  /// The second clip from the next frame on, at the root's place.
  kCut,
  /// Both clips are played for 0.3 s; slerp of every joint in its parent, and mean of the
  /// velocity of the root in its heading frame, with a smooth weight (Unity, Unreal,
  /// ozz).
  kCrossfade,
  /// Only the second clip is played; the difference of value and velocity of every joint,
  /// of the hips' height and of the root's velocity decays critically damped, half-life
  /// 0.1 s (Bollo 2016; Holden 2023).
  kInertial,
  /// The first clip is continued by its last velocities, which decay with a half-life of
  /// 0.15 s, and crossfaded to the second one within 0.3 s (Holden 2023).
  kDead,
};

struct RivalOptions {
  RivalMethod method = RivalMethod::kCrossfade;
  /// Enters the second clip where its supports agree best with the first one's: anywhere
  /// in a cyclic clip, else within 0.5 s of the requested time.
  bool is_synchronised = false;
  /// The root follows the bearing feet of the blended posture during the transition.
  bool is_anchored = false;
};

/// Returns the method's name for a table.
[[nodiscard]] std::string_view name(RivalMethod method);

/// Returns the time of the second clip at which a synchronised method enters. [s]
[[nodiscard]] double synchronised_entry_s(const SwitchCase& played);

/// Plays a switch at kTransitionRate_hz, kPlayedAround_s and two frames before and after
/// it.
/// Precondition: both clips are of one body and long enough round the switch; entry
/// kPlayedAround_s and two frames before the end of the second one.
[[nodiscard]] TransitionResult play_rival(const SwitchCase& played,
                                          const RivalOptions& options);

}  // namespace marey
