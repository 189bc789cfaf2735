// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live_chain/live_balance.h"

#include <algorithm>
#include <utility>

#include "core/base/assert.h"
#include "retarget/body/place_masses.h"

namespace marey::app {

LiveBalance::LiveBalance(std::span<const Skeleton* const> bodies) {
  for (const Skeleton* skeleton : bodies) {
    auto& body = bodies_.emplace_back();
    auto map = retarget::map_body(*skeleton);
    if (!map) continue;
    auto masses = retarget::place_masses(*skeleton, *map, {});
    if (!masses) continue;
    body.emplace(*skeleton,
                 *std::move(map),
                 *std::move(masses),
                 std::vector<RigidTransform>(skeleton->joints.size()),
                 retarget::BalanceFrame{},
                 LiveZmp{});
  }
}

void LiveBalance::step(const Pose& performer, double since_last_s) {
  MAREY_ASSERT(!bodies_.empty());
  time_s_ += since_last_s;
  auto& body = bodies_.front();
  if (!body) return;
  world_from_joints(body->skeleton, performer, body->world_from_joint);
  stance_.step(body->map, body->world_from_joint, since_last_s);
}

void LiveBalance::reset() {
  stance_.reset();
  for (auto& body : bodies_) {
    if (!body) continue;
    body->zmp.reset();
    body->measured_s.reset();
  }
}

const retarget::BalanceFrame* LiveBalance::measure(std::size_t body,
                                                   const Pose& posture,
                                                   std::span<const HandleState> handles) {
  MAREY_ASSERT(body < bodies_.size());
  if (!bodies_.front() || !bodies_[body]) return nullptr;
  Body& of = *bodies_[body];
  auto standing = stance_.standing();
  for (int side = 0; side < 2; ++side) {
    const JointIndex foot = of.map.leg(side).end;
    const bool is_held = std::ranges::any_of(handles, [foot](const HandleState& handle) {
      return handle.active && handle.joint == foot;
    });
    if (is_held) standing[static_cast<std::size_t>(side)] = {};
  }
  world_from_joints(of.skeleton, posture, of.world_from_joint);
  balance_of_posture(of.map, of.masses, of.world_from_joint, standing, of.balance);
  const double since_last_s = of.measured_s ? time_s_ - *of.measured_s : time_s_;
  if (since_last_s > 0.0) {
    of.zmp.step(of.balance.centre_of_mass_in_world, since_last_s);
    of.measured_s = time_s_;
  }
  of.balance.zmp_xz_m = of.zmp.on_floor(0.0);
  return &of.balance;
}

}  // namespace marey::app
