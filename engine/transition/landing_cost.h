// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "engine/clips/rig.h"
#include <glm/vec3.hpp>

#include "core/engine/motion_clip.h"

namespace marey::engine {

/// Feet of a clip on a body at one of its times, while it plays at a rate.
struct ClipFeet {
  /// Ankles from the hips' place on the floor, in the heading frame; left, right. [m]
  std::array<glm::dvec3, 2> ankle_m{};
  /// Their velocities over the floor, in the same frame. [m/s]
  std::array<glm::dvec3, 2> velocity_m_s{};
  std::array<bool, 2> bears{};  ///< Now, or within the next 0.1 s.
  std::array<bool, 2> bears_now{};
};

/// Returns the feet of a clip at a time. Precondition: rate > 0.
[[nodiscard]] ClipFeet clip_feet(const Rig& rig,
                                 const MotionClip& clip,
                                 double source_s,
                                 double rate);

/// Returns how far feet have to be moved when the greater weight passes from one clip to
/// another [m]: for a foot on which the new clip bears, its distance from its place in
/// that clip, and what it moves on in 0.1 s if it is in the air; for other feet 0.3 of
/// their distance.
[[nodiscard]] double landing_cost(const ClipFeet& from, const ClipFeet& to);

/// A change from one clip to another by a fade.
struct EntryQuestion {
  const Rig* rig = nullptr;
  const MotionClip* from = nullptr;
  double from_source_s = 0.0;  ///< Now.
  double from_rate = 1.0;
  const MotionClip* to = nullptr;
  double to_rate = 1.0;
  double asked_s = 0.0;  ///< Asked time in `to`.
  /// Range of times in `to`; a clip that loops is entered anywhere if `anywhere`.
  double first_s = 0.0;
  double last_s = 0.0;
  bool anywhere = false;
  double fade_s = 0.3;
  double max_delay_s = 0.0;  ///< The fade may begin this much later.
};

struct EntryAnswer {
  double entry_s = 0.0;  ///< Time of `to` now.
  double delay_s = 0.0;  ///< Until the fade begins.
  double cost_m = 0.0;
};

/// Returns the cost of a change whose fade begins after a delay: landing_cost() in the
/// middle of the fade, when `to` is at `to_source_s`, and 1 m for each second of the fade
/// in which one bears on the left foot alone and the other on the right one.
[[nodiscard]] double entry_landing_cost(const EntryQuestion& question,
                                        double delay_s,
                                        double to_source_s);

/// Returns the entry and delay of least cost, in steps of 1/60 s and 0.04 s. A delay
/// costs 0.1 m for a second, a distance from the asked time 0.02 m. About a hundred
/// microseconds for a second; allocates nothing. Precondition: rates > 0.
[[nodiscard]] EntryAnswer choose_entry(const EntryQuestion& question);

}  // namespace marey::engine
