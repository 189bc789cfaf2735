// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/engine/motion_clip.h"
#include "core/pose.h"
#include "retarget/body/normalized_pose.h"

namespace marey::engine {

/// Place of a character's hips on the floor.
struct RootPlace {
  double x_m = 0.0;
  double z_m = 0.0;
  double heading_rad = 0.0;  ///< Not wrapped: 0 faces +Z, positive turns towards +X.
};

/// Returns the place in a clip [legs as metres]. A clip that loops has one at any time,
/// with the path of its cycles; the time of another one is clamped to its ends.
[[nodiscard]] RootPlace path_at(const MotionClip& clip, double time_s);

/// Returns `to` seen from `from`: the displacement in from's heading frame, and the turn.
[[nodiscard]] RootPlace relative(const RootPlace& from, const RootPlace& to);
/// Returns `from` moved by a relative place: inverse of relative().
[[nodiscard]] RootPlace moved(const RootPlace& from, const RootPlace& by);

/// Samples the posture of a clip: interpolate() between its frames, cubic for height and
/// folds. A clip that loops is periodic; another one is clamped.
void sample_clip(const MotionClip& clip, double time_s, BlendPosture& out);

/// Returns the foot parts that bear at a time: bits by ClipFootPart.
[[nodiscard]] unsigned bearing_at(const MotionClip& clip, double time_s);

/// Converts to the form that retarget::expand() takes, at a place in the world.
/// `leg_length_m` is that of the body on which it will be expanded.
void to_normalized(const BlendPosture& posture,
                   const PostureLayout& layout,
                   const RootPlace& root,
                   double leg_length_m,
                   retarget::NormalizedPose& out);

/// Inverse of to_normalized(), for a posture with complete limbs. `near_heading_rad`: the
/// returned heading is the one within half a turn of it.
void from_normalized(const retarget::NormalizedPose& pose,
                     const PostureLayout& layout,
                     double leg_length_m,
                     double near_heading_rad,
                     BlendPosture& posture,
                     RootPlace& root);

}  // namespace marey::engine
