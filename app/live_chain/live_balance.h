// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "app/live_chain/live_handles.h"
#include "core/character.h"
#include "core/pose.h"
#include "core/skeleton.h"
#include "retarget/balance/measure_balance.h"
#include "retarget/body/body_map.h"
#include "retarget/feet/live_stance.h"

namespace marey::app {

/// Where the weight of a live performer and of its avatars is, and what bears it: what
/// `marey view` tells of recordings, posture by posture. All stand on what the performer
/// stands on, which is judged as its postures come.
///
/// Same postures and time steps, same answers, to the bit. Some microseconds a body;
/// allocates nothing once every body was looked at.
class LiveBalance {
 public:
  /// The performer, then avatars. Nothing is told of bodies that are not human, or have
  /// no masses.
  explicit LiveBalance(std::span<const Skeleton* const> bodies);

  /// The performer's next posture. Precondition: since_last_s > 0.
  void step(const Pose& performer, double since_last_s);
  /// Its next posture is taken as a first one.
  void forget() { stance_.reset(); }

  /// What the performer stands on since the last step().
  [[nodiscard]] const std::array<retarget::StandingFoot, 2>& standing() const {
    return stance_.standing();
  }
  /// Of one body in this posture; feet whose handle is held bear nothing. nullptr: nobody
  /// knows. Valid until the next call for this body.
  [[nodiscard]] const retarget::BalanceFrame* look(
      std::size_t body, const Pose& posture, std::span<const HandleState> handles = {});

 private:
  struct Body {
    Skeleton skeleton;
    retarget::BodyMap map;
    std::vector<PointMass> masses;
    std::vector<RigidTransform> world_from_joint;
    retarget::BalanceFrame balance;
  };

  std::vector<std::optional<Body>> bodies_;
  retarget::LiveStance stance_;
};

}  // namespace marey::app
