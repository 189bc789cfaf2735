// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "engine/clips/sample_clip.h"
#include "engine/models/hand_motion.h"
#include "engine/models/quintic_leg.h"
#include <glm/vec3.hpp>

#include "core/base/result.h"

namespace marey::engine {

/// The parameters of a throw at the release of the ball, in the hips' heading frame of
/// that instant: its origin is the hips' place on the floor, +Z the heading, +Y up.
struct ThrowParameters {
  glm::dvec3 wrist_in_heading_m{0.0};
  /// Direction of the ball's velocity: 0 is the heading, positive towards +X.
  double azimuth_rad = 0.0;
  double elevation_rad = 0.0;  ///< Positive is up; in [-pi/2, pi/2].
  double speed_m_s = 0.0;      ///< For the ball.
  double release_s = 0.0;      ///< Since the start of the clip.
};

/// Changed parameters of a throw. The others keep their captured values.
struct ThrowChanges {
  std::optional<double> x_m;
  std::optional<double> y_m;
  std::optional<double> z_m;
  std::optional<double> azimuth_rad;
  std::optional<double> elevation_rad;
  std::optional<double> speed_m_s;
  std::optional<double> release_s;
};

/// Errors (bad input, naming the parameter): a number that is not finite, speed <= 0,
/// elevation outside of [-pi/2, pi/2], release outside of [0, duration_s].
[[nodiscard]] Status check_throw(const ThrowChanges& asked, double duration_s);

/// Returns the captured parameters replaced where the changes name one.
[[nodiscard]] ThrowParameters with_changes(const ThrowParameters& captured,
                                           const ThrowChanges& asked);

/// The thrower at the release.
struct ThrowInstant {
  HandMotion wrist;
  RootPlace root;
  /// Centre of the ball from the wrist, in the T-pose's axes (HandMotion::
  /// world_from_hand turns it). [m]
  glm::dvec3 lever_in_hand_m{0.0};
};

/// Returns the place of the ball in the world. [m]
[[nodiscard]] glm::dvec3 ball_place(const ThrowInstant& thrower);
/// Returns the velocity of the wrist plus the hand's angular velocity times the lever.
[[nodiscard]] glm::dvec3 ball_velocity_m_s(const ThrowInstant& thrower);

/// Computes the seven parameters of a throw as it is. `release_s` is copied.
[[nodiscard]] ThrowParameters measure_throw(const ThrowInstant& at_release,
                                            double release_s);

/// Returns the direction of a throw in the world. Unit.
[[nodiscard]] glm::dvec3 throw_direction(double heading_rad,
                                         double azimuth_rad,
                                         double elevation_rad);

/// Input of one step of a throw.
struct ThrowInput {
  double time_s = 0.0;
  double step_s = 0.0;  ///< > 0.
  HandMotion clip_now;  ///< The wrist of the played clip, on this body.
  /// The thrower of the played clip at `release_s`, without the displacement, under the
  /// current prediction of the root.
  ThrowInstant clip_at_release;
  double release_s = 0.0;  ///< In the time of the engine.
};

/// A ball that has left the hand.
struct BallRelease {
  double time_s = 0.0;
  glm::dvec3 p_in_world{0.0};
  glm::dvec3 velocity_m_s{0.0};
};

struct ThrowOutput {
  HandMotion wrist;  ///< The wanted wrist at ThrowInput::time_s; the hand's rotation is
                     ///< the clip's.
  bool displaced = false;
  double remaining_s = 0.0;  ///< Until the release; negative after it.
  /// Set in the step in which the ball leaves: between the last time and this one.
  std::optional<BallRelease> release;
};

/// A throw whose parameters change one at a time (Kulpa 2005, 7.2.2; Fradet 2003): a
/// displacement of the wrist, polynomials of degree five before and after the release,
/// with two continuous derivatives, zero outside of `half_width_s` about it. Its value
/// and rate at the release are such that place and velocity of the ball are as asked.
/// Recomputed in each step from its current state, except in the last two steps. A throw
/// that names nothing displaces nothing, to the bit. No function allocates.
class ThrowCourse {
 public:
  /// Precondition: check_throw() accepts the changes; half_width_s > 0.
  void start(double time_s,
             const ThrowParameters& captured,
             const ThrowChanges& asked,
             double half_width_s = 0.35);

  /// Changes the wanted parameters, also if start() did not name them. Has no
  /// effect on the last two steps before the release.
  void want(const ThrowParameters& wanted);
  [[nodiscard]] const ThrowParameters& wanted() const { return wanted_; }

  /// Precondition: started; times ascend by at most a few steps.
  ThrowOutput step(const ThrowInput& input);

  /// Returns the displacement of the present plan at a time; zero without a plan.
  [[nodiscard]] Motion3 planned(double time_s) const;

 private:
  [[nodiscard]] Motion3 wanted_displacement(const ThrowInstant& clip_at_release) const;

  ThrowParameters wanted_;
  bool is_displaced_ = false;  // Anything is named.
  double half_width_s_ = 0.35;
  double time_s_ = 0.0;
  bool has_plan_ = false;
  bool has_released_ = false;
  Motion3 moved_;
  QuinticLeg leg_;
};

}  // namespace marey::engine
