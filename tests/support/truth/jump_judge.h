// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <glm/vec3.hpp>

#include "core/base/frame_range.h"
#include "core/character.h"
#include "core/motion.h"

namespace marey::testing {

/// A flight as its poses show it, by plain least squares with free fall of 9.81 m/s^2.
struct JudgedFlight {
  double apex_m = 0.0;          ///< Highest point of the parabola, world Y.
  double off_parabola_m = 0.0;  ///< Largest distance of a frame's centre of mass from it.
  glm::dvec3 p0_in_world{0.0};  ///< At the first pose of the motion.
  glm::dvec3 v0_m_s{0.0};

  /// Returns the time between the passage of a height upwards and of another downwards;
  /// 0 if the parabola does not reach them.
  [[nodiscard]] double airtime_s(double takeoff_m, double touchdown_m) const;
  [[nodiscard]] glm::dvec3 at(double time_s) const;
};

/// Fits a parabola to the centre of mass over the frames of a range.
[[nodiscard]] JudgedFlight judge_flight(const Motion& motion,
                                        std::span<const PointMass> masses,
                                        const FrameRange& frames);

/// Returns the largest third derivative of a joint's place in the world over the frames
/// of a range, by third differences. [m/s^3] Joints are placed by world_from_joints().
[[nodiscard]] double largest_jerk_m_s3(const Motion& motion, const FrameRange& frames);

}  // namespace marey::testing
