// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "dynamics/balance/preview_control.h"
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/base/time.h"
#include "core/character.h"
#include "core/pose.h"
#include "core/skeleton.h"
#include "core/transform.h"
#include "retarget/balance/measure_balance.h"
#include "retarget/body/body_map.h"
#include "retarget/com/close_com_over_feet.h"

namespace marey::app {

/// Durations of LivePreview, in frames.
struct PreviewTimes {
  FrameRate rate;
  std::int64_t delay = 0;        ///< From the newest frame to the one that is shown.
  std::int64_t half_window = 0;  ///< Frames on each side of a derivative.
  std::int64_t fade = 0;         ///< Duration in which a foot is released or held.

  /// Number of frames that are kept: the delay, and a fade before it.
  [[nodiscard]] std::int64_t kept() const { return delay + fade + 1; }
  /// Place of a frame in a ring of kept() entries. Precondition: frame >= 0.
  [[nodiscard]] std::size_t slot(std::int64_t frame) const {
    return static_cast<std::size_t>(frame % kept());
  }
};

/// Returns the displacement that takes a zero moment point into its support area, and 0
/// for points further inside than a small margin; continuous in the point. At most 0.15
/// m. Areas without an inside give 0. Linear in corners.
[[nodiscard]] glm::dvec2 wanted_zmp_shift_m(std::span<const glm::dvec2> corners,
                                            const glm::dvec2& zmp_xz_m);

/// One body of a delayed stream whose zero moment point is kept nearer to the support
/// area: cart-table preview control (dynamics/balance/preview_control.h) with the height
/// of the centre of mass at rest. Frames are evenly spaced. Deterministic to the bit; no
/// function allocates after the first frames.
class PreviewBody {
 public:
  /// A body that is not humanoid or has no masses is only delayed.
  PreviewBody(const Skeleton& skeleton, const PreviewTimes& times);
  PreviewBody(const PreviewBody&) = delete;
  PreviewBody& operator=(const PreviewBody&) = delete;

  /// Adds the next frame: the posture `share` of the way from the last one to `pose`; 1
  /// is `pose` itself, 0 repeats the last one. Precondition: the pose has the joints.
  void push(const Pose& pose, double share);
  /// Plans the displacement of the frame that is shown. `is_known` is true if the newest
  /// 2 * half_window + 1 frames belong to one movement; then `standing` are the feet of
  /// the frame in the middle of these. Called once per frame: after push(), or alone for
  /// frames that are skipped.
  void plan(bool is_known, const std::array<retarget::StandingFoot, 2>& standing);
  /// Writes a frame that is still kept, unchanged.
  void copy(std::int64_t frame, Pose& out) const { out = poses_[times_.slot(frame)]; }
  /// Writes the frame `delay` before the newest one, with the planned displacement of the
  /// centre of mass and both feet at their places by their holds (FootGoal::hold).
  /// Precondition: there is such a frame.
  void show(const std::array<double, 2>& holds, Pose& out);

  /// Returns the planned displacement of the centre of mass, X and Z. [m]
  [[nodiscard]] const glm::dvec2& shift_xz_m() const { return shift_xz_m_; }

 private:
  struct Weight {
    Weight(const Skeleton& skeleton,
           retarget::BodyMap body_map,
           std::vector<PointMass> point_masses,
           const PreviewTimes& times);

    retarget::BodyMap map;
    std::vector<PointMass> masses;
    retarget::ComFollower follower;  // Refers to the two above.
    retarget::ComCloser closer;
    dynamics::PreviewBalance balance;
    std::vector<glm::dvec3> com_in_world;  // Ring.
    std::vector<double> curvature;         // Weights of a window. [1/s^2]
    retarget::BalanceFrame frame;
  };

  [[nodiscard]] std::optional<glm::dvec2> wanted_xz_m(
      const std::array<retarget::StandingFoot, 2>& standing);

  Skeleton skeleton_;
  PreviewTimes times_;
  std::vector<Pose> poses_;  // Ring.
  std::vector<RigidTransform> world_from_joint_;
  std::optional<Weight> weight_;
  std::int64_t newest_ = -1;
  double kept_share_ = 0.0;  // Share of the displacement that a frame without a point keeps.
  glm::dvec2 wanted_xz_m_{0.0};
  glm::dvec2 shift_xz_m_{0.0};
};

}  // namespace marey::app
