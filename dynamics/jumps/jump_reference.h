// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "dynamics/jumps/jump.h"
#include "dynamics/jumps/support_push.h"
#include <glm/vec3.hpp>

#include "core/base/time.h"
#include "core/human/body_track.h"
#include "core/signal/cubic_spline.h"

namespace marey::dynamics {

/// Strength of a body over the peak of a captured push, and the least strength. [g]
inline constexpr double kStrengthOfPeak = 1.3;
inline constexpr double kMinStrength_g = 2.5;

/// A captured jump, prepared for changes: the forces of its push and landing, the path of
/// the centre of mass, and the rest that these do not explain.
///
/// The path is a model plus a residual: the push from the state at P1 by the captured
/// force, the parabola of the flight, the landing by the captured force. The residual
/// holds errors of the capture's joints and masses, some millimetres.
class JumpReference {
 public:
  /// Forces are the second derivative of a quintic smoothing spline through the centre of
  /// mass (generalised cross-validation), plus gravity; negative vertical ones count as
  /// 0. nullopt: fewer than 20 frames, or the captured forces cannot join the captured
  /// states. Linear in frames.
  /// Precondition: `jump` was found in `track`.
  [[nodiscard]] static std::optional<JumpReference> make(const BodyTrack& track,
                                                         const Jump& jump);

  [[nodiscard]] const Jump& jump() const { return jump_; }
  [[nodiscard]] const SupportReference& push() const { return *push_; }
  /// Strength that a plan uses if none is given.
  [[nodiscard]] double strength_g() const {
    return std::max(kMinStrength_g, kStrengthOfPeak * push_->peak_g);
  }
  /// nullptr: the clip ends before the landing does.
  [[nodiscard]] const SupportReference* landing() const { return landing_.get(); }
  [[nodiscard]] const SupportPush& push_model() const { return push_model_; }
  [[nodiscard]] const std::optional<SupportPush>& landing_model() const {
    return landing_model_;
  }

  /// Returns the captured position, between frames by splines. Time since the first pose.
  [[nodiscard]] glm::dvec3 captured(double time_s) const;
  /// Returns the captured position less the model. Precondition: within the jump.
  [[nodiscard]] glm::dvec3 residual(double time_s) const;
  /// Returns the vertical captured force per kilogram, smoothed, in captured gravity.
  [[nodiscard]] double captured_push_g(double time_s) const;
  /// Largest residual during the flight. [m]
  [[nodiscard]] double flight_residual_m() const { return flight_residual_m_; }
  /// Time of the last frame.
  [[nodiscard]] double end_s() const { return end_s_; }
  /// End of the jump: P5, P4 or the clip's end.
  [[nodiscard]] double jump_end_s() const;

 private:
  [[nodiscard]] glm::dvec3 modelled(double time_s) const;

  Jump jump_;
  double end_s_ = 0.0;
  double rate_hz_ = 0.0;
  std::vector<CubicSpline> path_;  ///< X, Y, Z.
  std::vector<double> push_g_;     ///< Per frame.
  /// On the heap, since the models point to them.
  std::shared_ptr<const SupportReference> push_;
  std::shared_ptr<const SupportReference> landing_;
  SupportPush push_model_;
  std::optional<SupportPush> landing_model_;
  double flight_residual_m_ = 0.0;
};

}  // namespace marey::dynamics
