// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/engine/blend_posture.h"

namespace marey::engine {

/// Velocities of a posture: angular velocities in the heading frame as rotation vectors
/// [rad/s], and rates of the other values [1/s].
struct PostureRates {
  BlendPosture::Rotations x{};
  BlendPosture::Rotations y{};
  BlendPosture::Rotations z{};
  std::array<float, 4> fold_rad{};
  std::array<float, 4> mid_x{};
  std::array<float, 4> mid_y{};
  std::array<float, 4> upper_twist{};
  std::array<float, 4> lower_twist{};
  float height = 0.0F;
};

/// Returns the rates from `before` to `now` in a step: (now - before) / step.
/// Precondition: step_s > 0.
[[nodiscard]] PostureRates rates_between(const BlendPosture& before,
                                         const BlendPosture& now,
                                         float step_s);

/// Turns and moves a posture by rates for a time, without decay or limits. Rotations turn
/// in the heading frame, by at most 240 degrees.
void move_posture(const PostureRates& rates, float time_s, BlendPosture& posture);

/// A decaying difference between a posture and the one that is played, so that a cut
/// looks continuous in value and velocity (Bollo 2016, "Inertialization"; the decay is
/// (x + (v + x y) t) e^(-y t), y = 2 ln 2 / half-life: Holden 2023). Differences of
/// nested cuts add up.
class InertialOffset {
 public:
  /// No difference.
  void reset() { is_active_ = false; }
  [[nodiscard]] bool is_active() const { return is_active_; }

  /// The played posture changes from `from` (as shown, this offset included) with
  /// `from_rates`, to `to` with `to_rates`: from now on the offset is their difference.
  void start(const BlendPosture& from,
             const PostureRates& from_rates,
             const BlendPosture& to,
             const PostureRates& to_rates);

  /// Decays the offset by `step_s` and adds it to `posture`. Becomes inactive when it is
  /// below 1e-6 everywhere.
  void step(float step_s, float half_life_s, BlendPosture& posture);

 private:
  bool is_active_ = false;
  BlendPosture::Rotations x_{};  ///< Rotation vectors, applied in the heading frame.
  BlendPosture::Rotations y_{};
  BlendPosture::Rotations z_{};
  std::array<float, 24> values_{};  ///< Extension, mid, twists, height, spine shares.
  PostureRates rates_{};            ///< For the offset.
};

/// Continues a posture whose source vanished: every velocity decays with `half_life_s`
/// (Holden 2023, "Dead blending"). `rates` decay along.
void extrapolate(float step_s,
                 float half_life_s,
                 PostureRates& rates,
                 BlendPosture& posture);

}  // namespace marey::engine
