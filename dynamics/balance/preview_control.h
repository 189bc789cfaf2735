// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "dynamics/push/push_ends.h"
#include <glm/vec2.hpp>

#include "core/base/time.h"

namespace marey::dynamics {

struct PreviewOptions {
  double preview_s = 0.8;  ///< Duration for which wanted points are known.
  double gravity_m_s2 = kStandardGravity_m_s2;
  double error_weight = 1.0;  ///< Weight of the summed error of the point.
  double jerk_weight = 1e-6;  ///< Weight of the squared jerk.
};

/// Gains of preview control of the cart-table model (Kajita et al. 2003): the jerk of the
/// centre of mass from the summed error of the zero moment point, the state (position,
/// velocity, acceleration), and the wanted points of the next frames.
struct PreviewGains {
  double of_error = 0.0;
  std::array<double, 3> of_state{};
  /// One per frame of the preview. The second half includes the gains of all later
  /// frames.
  std::vector<double> of_preview;
};

/// Computes the gains by iterating the Riccati equation. Cost: some thousand products of
/// 4 x 4 matrices. Preconditions: rate, height, preview and weights above 0.
[[nodiscard]] PreviewGains preview_gains(FrameRate rate,
                                         double height_m,
                                         const PreviewOptions& options = {});

/// Moves a centre of mass at constant height so that its zero moment point follows wanted
/// points, which are known for `preview_s`. Both horizontal axes are independent.
class PreviewControl {
 public:
  /// Preconditions: those of preview_gains().
  PreviewControl(FrameRate rate, double height_m, const PreviewOptions& options = {});

  /// Returns the number of wanted points that step() needs: the latency in frames.
  [[nodiscard]] std::size_t preview_frames() const { return gains_.of_preview.size(); }
  [[nodiscard]] const PreviewGains& gains() const { return gains_; }

  /// Places the centre of mass at rest over a point.
  void reset(const glm::dvec2& p_xz_m);
  /// Advances by one frame. `wanted_xz_m` has the point of this frame and the following
  /// preview_frames() points; the last one is repeated if it has fewer, and more are not
  /// used. Allocates nothing. Precondition: at least one point.
  void step(std::span<const glm::dvec2> wanted_xz_m);

  [[nodiscard]] glm::dvec2 com_xz_m() const { return position_; }
  [[nodiscard]] glm::dvec2 velocity_m_s() const { return velocity_; }
  /// Returns the zero moment point of the present state.
  [[nodiscard]] glm::dvec2 zmp_xz_m() const;

 private:
  double period_s_ = 0.0;
  double lever_s2_ = 0.0;  // Height over gravity.
  PreviewGains gains_;
  glm::dvec2 position_{0.0};
  glm::dvec2 velocity_{0.0};
  glm::dvec2 acceleration_{0.0};
  glm::dvec2 error_sum_{0.0};
};

/// Displacement of the centre of mass of a stream that moves its zero moment point: the
/// stream is delayed by the preview, in which wanted displacements of the point are
/// known.
class PreviewBalance {
 public:
  /// Preconditions: those of preview_gains().
  PreviewBalance(FrameRate rate, double height_m, const PreviewOptions& options = {});

  /// Returns the delay of the stream. [frames]
  [[nodiscard]] std::size_t latency_frames() const { return control_.preview_frames(); }
  /// Starts a new stream.
  void reset();
  /// Takes the wanted displacement of the zero moment point of the newest frame. Returns
  /// the displacement of the centre of mass of the frame latency_frames() before; 0
  /// before the first frame. [m] Allocates nothing. Cost: linear in the preview.
  glm::dvec2 step(const glm::dvec2& zmp_shift_xz_m);

 private:
  PreviewControl control_;
  std::vector<glm::dvec2> known_;  // From the delayed frame on.
  std::size_t received_ = 0;
};

}  // namespace marey::dynamics
