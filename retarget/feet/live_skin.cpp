// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/feet/live_skin.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/pose.h"

namespace marey::retarget {
namespace {

constexpr double kSlack_m = 1e-3;
constexpr int kMaxPasses = 4;

// Returns the lift that brings a posture above the floor. A foot that does not stand
// rises with the body.
SkinLift needed_lift(const SkinLows& lows,
                     double allowed_m,
                     const std::array<StandingFoot, 2>& standing,
                     bool holds_feet) {
  const auto depth_m = [&](SkinPart part) {
    const double m = -lows[index(part)] - allowed_m;
    return m > kSlack_m ? m : 0.0;
  };
  SkinLift out;
  for (const SkinPart part : lifting_parts()) {
    out.root_m = std::max(out.root_m, depth_m(part));
  }
  for (int side = 0; side < 2; ++side) {
    const auto s = static_cast<std::size_t>(side);
    const bool held = holds_feet && (standing[s].heel || standing[s].ball);
    const double with_body_m =
        held ? std::min(out.root_m, depth_m(on_side(SkinPart::kLeftShank, side)))
             : out.root_m;
    out.ankle_m[s] = std::max(with_body_m, depth_m(on_side(SkinPart::kLeftFoot, side)));
    out.wrist_m[s] =
        std::max(0.0, depth_m(on_side(SkinPart::kLeftHand, side)) - out.root_m);
  }
  return out;
}

void add(const SkinLift& more, SkinLift& lift) {
  lift.root_m += more.root_m;
  for (std::size_t s = 0; s < 2; ++s) {
    lift.ankle_m[s] += more.ankle_m[s];
    lift.wrist_m[s] += more.wrist_m[s];
  }
}

}  // namespace

LiveSkinLift::LiveSkinLift(Skin skin, double fall_s, double limb_fall_s)
    : skin_(std::move(skin)), fall_s_(fall_s), limb_fall_s_(limb_fall_s) {}

void LiveSkinLift::step(const Skeleton& body,
                        const BodyMap& map,
                        const std::array<StandingFoot, 2>& standing,
                        double allowed_m,
                        double since_last_s,
                        std::span<RigidTransform> world_from_joint,
                        Pose& pose) {
  if (skin_.empty()) return;
  rows_.resize(world_from_joint.size());
  // The remainder of the last lift, plus the missing rise.
  SkinLift lift = last_;
  const double left = std::exp(-since_last_s / fall_s_);
  const double limb_left = std::exp(-since_last_s / limb_fall_s_);
  for (std::size_t s = 0; s < 2; ++s) {
    // The part of an ankle's rise that came from the body comes down with it.
    const double own_m = lift.ankle_m[s] - lift.root_m;
    lift.ankle_m[s] = left * lift.root_m + limb_left * own_m;
    lift.wrist_m[s] *= limb_left;
  }
  lift.root_m *= left;
  if (!lift.is_zero()) lift_posture(body, map, lift, world_from_joint, scratch_, pose);
  for (int pass = 0; pass < kMaxPasses; ++pass) {
    world_from_joints(body, pose, world_from_joint);
    SkinLows lows{};
    skin_.lows(world_from_joint, 0.0, rows_, lows);
    const SkinLift more = needed_lift(lows, allowed_m, standing, pass == 0);
    if (more.is_zero()) break;
    lift_posture(body, map, more, world_from_joint, scratch_, pose);
    add(more, lift);
  }
  world_from_joints(body, pose, world_from_joint);
  last_ = lift;
}

}  // namespace marey::retarget
