// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "benchmarks/engine/transition_clips.h"
#include "core/base/result.h"
#include "core/human/contacts.h"
#include "core/motion.h"
#include "core/pose.h"

namespace marey {

/// One cycle of a clip that repeats.
struct LoopClip {
  std::string name;
  /// N + 1 poses: the last one is the first one moved by one cycle.
  Motion motion;
  retarget::BodyMap map;
  Contacts contacts;  ///< One contact frame per pose.
  /// Movement of one cycle on the floor: a turn about the vertical of the world's origin,
  /// then a shift along X and Z.
  double turn_rad = 0.0;
  glm::dvec2 shift_xz_m{0.0};

  /// N.
  [[nodiscard]] int cycle_frames() const {
    return static_cast<int>(motion.poses.size()) - 1;
  }
};

/// Makes a loop of the best cycle of a clip by `marey edit`'s cyclify. Errors: its.
[[nodiscard]] Result<LoopClip> make_loop_clip(const TransitionClip& clip);

/// Plays a loop: returns the posture at frame k >= 0 of the loop's rate, in the world of
/// the clip, so that frame 0 is its first pose. Called with k ascending by one.
using LoopPlayer = std::function<Pose(int)>;

/// Figures of a played loop.
struct LoopFigures {
  int cycles = 0;
  /// Largest distance on the floor, over all starts of cycles, of the played hips from
  /// those of the clip moved by as many whole cycles. [mm]
  double path_error_mm = 0.0;
  double heading_error_deg = 0.0;  ///< The same of the yaw of the hips.
  /// Largest distance of the joint of a named bone (BodyMap) from the clip's in the last
  /// cycle, hips on hips. Postures of the engine have these alone.
  double bone_error_mm = 0.0;
  /// The same of all joints and tips. [mm]
  double posture_error_mm = 0.0;
  /// Largest acceleration of a joint or tip in the last cycle: in the frame at the seam
  /// and its two neighbours, and in all other frames. [m/s^2]
  double seam_m_s2 = 0.0;
  double inner_m_s2 = 0.0;
};

/// Plays `cycles` cycles and some frames, and compares them with whole cycles in double
/// precision.
/// Precondition: cycles >= 2; the player's poses have the joints of the clip.
[[nodiscard]] LoopFigures judge_loop(const LoopClip& loop,
                                     const LoopPlayer& player,
                                     int cycles = 100);

/// Plays the poses of the clip moved by whole cycles in double precision.
[[nodiscard]] LoopPlayer exact_loop_player(const LoopClip& loop);

/// Adds single-precision root steps in the world, as engines with float transforms do.
[[nodiscard]] LoopPlayer float_loop_player(const LoopClip& loop);

}  // namespace marey
