// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "app/live_chain/live_handles.h"
#include "app/live_chain/live_zmp.h"
#include "core/character.h"
#include "core/pose.h"
#include "core/skeleton.h"
#include "retarget/balance/measure_balance.h"
#include "retarget/body/body_map.h"
#include "retarget/feet/live_stance.h"

namespace marey::app {

/// Computes centre of mass and support of a live performer and of its avatars, pose by
/// pose; `marey view` shows the same values of recordings. The zero moment point is an
/// estimate (LiveZmp). All bodies share the
/// supporting feet of the performer, which are detected from its poses.
///
/// The same poses and time steps give bit-identical results. Cost: some microseconds per
/// body; no allocation after the first measure() of every body.
class LiveBalance {
 public:
  /// `bodies` is the performer, then the avatars. Bodies that are not humanoid or have no
  /// masses have no balance.
  explicit LiveBalance(std::span<const Skeleton* const> bodies);

  /// Processes the performer's next pose. Precondition: since_last_s > 0.
  void step(const Pose& performer, double since_last_s);
  /// Resets the detection of supporting feet: the next pose is treated as the first.
  void reset();

  /// Returns the performer's supporting feet as of the last step().
  [[nodiscard]] const std::array<retarget::StandingFoot, 2>& standing() const {
    return stance_.standing();
  }
  /// Returns the balance of one body in this pose, or nullptr if it is unknown. A foot
  /// with an active handle does not support. Valid until the next call for this body.
  [[nodiscard]] const retarget::BalanceFrame* measure(
      std::size_t body, const Pose& posture, std::span<const HandleState> handles = {});

 private:
  struct Body {
    Skeleton skeleton;
    retarget::BodyMap map;
    std::vector<PointMass> masses;
    std::vector<RigidTransform> world_from_joint;
    retarget::BalanceFrame balance;
    LiveZmp zmp;
    /// Time of the last measure(). The same pose may be measured again.
    std::optional<double> measured_s{};
  };

  std::vector<std::optional<Body>> bodies_;
  retarget::LiveStance stance_;
  double time_s_ = 0.0;  ///< Sum of the time steps.
};

}  // namespace marey::app
