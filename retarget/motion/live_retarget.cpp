// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/motion/live_retarget.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/assert.h"
#include "retarget/feet/adapt_to_ground.h"
#include "retarget/feet/leg_placement.h"
#include "retarget/feet/live_foot.h"
#include "retarget/feet/live_skin.h"
#include "retarget/feet/unroll_feet.h"
#include "retarget/hands/keep_wrists.h"
#include "retarget/motion/retarget_motion.h"

namespace marey::retarget {

struct LiveRetarget::State {
  Skeleton source;
  Skeleton avatar;
  BodyMap from;
  BodyMap to;
  LiveRetargetOptions options;
  double scale = 1.0;  // Scale of the root's path.
  bool wrists_to_keep = false;
  double sink_m = 0.0;
  LiveStance stance;  // Stance of the source.
  std::array<LiveFoot, 2> feet;
  BodyVolume source_volume;
  BodyVolume avatar_volume;
  LiveHands hands;
  LiveSkinLift skin;
  NormalizedPose posture;
  FootUnroller unroller;
  std::vector<RigidTransform> source_world;
  std::vector<RigidTransform> avatar_world;

  [[nodiscard]] double rise_m() const;
  [[nodiscard]] double depth_m() const;
  void hold_feet(double since_last_s);
  void move_hands(double rise_m, double since_last_s, Pose& out);
};

// Returns the rise of the root, after scaling with the legs, that puts ankles resting
// like the source's at the avatar's height.
double LiveRetarget::State::rise_m() const {
  const std::array<double, 2> rest_m{
      from.feet[0].ankle_height_m + stance.floor_offset_legs(0) * from.leg_length_m,
      from.feet[1].ankle_height_m + stance.floor_offset_legs(1) * from.leg_length_m};
  return standing_rise_m(from, rest_m, to, scale);
}

// Keeps feet in their stances, lowers the hips where necessary, and solves the legs.
void LiveRetarget::State::hold_feet(double since_last_s) {
  const double unit_m = root_unit_m(to, options.root);
  const std::array<StandingFoot, 2>& standing = stance.standing();
  const glm::dvec3 root = avatar_world[index(to.hips())].translation;
  std::array<FootPlace, 2> places;
  std::array<glm::dvec3, 2> hips{};
  double needed_m = 0.0;
  for (int side = 0; side < 2; ++side) {
    const auto s = static_cast<std::size_t>(side);
    places[s] = foot_of(to, posture, avatar_world, side);
    hips[s] = avatar_world[index(to.leg(side).upper)].translation;
    feet[s].hold(
        standing[s], to.feet[s], to.leg_length_m, since_last_s, options.foot, places[s]);
    if (!standing[s].heel && !standing[s].ball) continue;
    const double straight =
        std::max(GroundOptions{}.straight, posture.limbs[2 + s]->extension);
    needed_m = std::max(
        needed_m,
        retarget::sink_m(
            hips[s], places[s].ankle_in_world, straight * to.leg(side).length_m()));
  }
  sink_m = std::max(needed_m, sink_m * std::exp(-since_last_s / options.rise_s));
  posture.root.y = (root.y - sink_m) / unit_m;
  for (int side = 0; side < 2; ++side) {
    const auto s = static_cast<std::size_t>(side);
    aim_leg(hips[s] - glm::dvec3(0.0, sink_m, 0.0),
            places[s].ankle_in_world,
            to.leg(side).length_m(),
            *posture.limbs[2 + s]);
    posture.segments[index(foot_bone(side))] = places[s].foot;
    posture.segments[index(toes_bone(side))] = places[s].toes;
  }
}

// Returns the depth of the source's joints (except the feet's) below its floor, Y = 0, at
// the avatar's size. The avatar's skin may be as deep.
double LiveRetarget::State::depth_m() const {
  double lowest_m = 0.0;
  for (const HumanBone bone : human_bones()) {
    const auto joint = from.joint_of[index(bone)];
    const bool is_foot = bone == foot_bone(0) || bone == foot_bone(1) ||
                         bone == toes_bone(0) || bone == toes_bone(1);
    if (!joint || is_foot) continue;
    lowest_m = std::min(lowest_m, source_world[index(*joint)].translation.y);
  }
  return -scale * lowest_m;
}

void LiveRetarget::State::move_hands(double rise_m, double since_last_s, Pose& out) {
  std::optional<double> source_floor_m;
  std::optional<double> floor_m;
  if (options.hold_feet) {
    source_floor_m = -rise_m / scale;
    floor_m = 0.0;
  }
  hands.move({from, source_volume, source_world, source_floor_m},
             {to, avatar_volume, avatar_world, floor_m},
             *options.hands,
             since_last_s,
             posture);
  expand(posture, avatar, to, avatar_world, out);
}

LiveRetarget::LiveRetarget(std::unique_ptr<State> state) : state_(std::move(state)) {}
LiveRetarget::LiveRetarget(LiveRetarget&&) noexcept = default;
LiveRetarget& LiveRetarget::operator=(LiveRetarget&&) noexcept = default;
LiveRetarget::~LiveRetarget() = default;

Result<LiveRetarget> LiveRetarget::make(const Skeleton& source,
                                        const Skeleton& avatar,
                                        const LiveRetargetOptions& options) {
  auto bodies = map_bodies(source, avatar, options.root);
  if (!bodies) return bodies.error();
  auto state = std::make_unique<State>();
  state->source = source;
  state->avatar = avatar;
  state->from = std::move(bodies->source);
  state->to = std::move(bodies->avatar);
  apply_soles(options.soles, state->to);
  state->options = options;
  state->stance = LiveStance(options.stance);
  state->scale =
      root_unit_m(state->to, options.root) / root_unit_m(state->from, options.root);
  state->skin =
      LiveSkinLift(std::move(state->options.skin), options.rise_s, options.foot.land_s);
  state->wrists_to_keep = spines_differ(state->from, state->to);
  if (options.hands) {
    const LiveHandsOptions& hands = *options.hands;
    state->source_volume =
        hands.source_volume ? *hands.source_volume : average_volume(source, state->from);
    state->avatar_volume =
        hands.avatar_volume ? *hands.avatar_volume : average_volume(avatar, state->to);
  }
  state->source_world.resize(source.joints.size());
  state->avatar_world.resize(avatar.joints.size());
  return LiveRetarget(std::move(state));
}

void LiveRetarget::step(const Pose& source, double since_last_s, Pose& out) {
  MAREY_ASSERT(since_last_s > 0.0);
  State& s = *state_;
  MAREY_ASSERT(source.parent_from_joint.size() == s.source.joints.size());
  world_from_joints(s.source, source, s.source_world);
  normalize(s.from, s.source_world, s.posture, s.options.root);
  s.unroller.step(s.from, s.source_world, s.posture);
  s.stance.step(s.from, s.source_world, since_last_s);
  const double rise_m = s.options.hold_feet ? s.rise_m() : 0.0;
  s.posture.root.y += rise_m / root_unit_m(s.to, s.options.root);
  expand(s.posture, s.avatar, s.to, s.avatar_world, out);
  if (s.wrists_to_keep) keep_wrists(s.avatar, s.to, s.avatar_world, s.posture);
  if (s.options.hold_feet) s.hold_feet(since_last_s);
  if (s.wrists_to_keep || s.options.hold_feet) {
    expand(s.posture, s.avatar, s.to, s.avatar_world, out);
  }
  if (s.options.hands) s.move_hands(rise_m, since_last_s, out);
  if (s.options.hold_feet) {
    s.skin.step(s.avatar,
                s.to,
                s.stance.standing(),
                s.depth_m(),
                since_last_s,
                s.avatar_world,
                out);
  }
}

void LiveRetarget::reset() {
  state_->stance.reset();
  state_->unroller = FootUnroller();
  for (LiveFoot& foot : state_->feet) foot.reset();
  state_->hands.reset();
  state_->skin.reset();
  state_->sink_m = 0.0;
}

const std::array<StandingFoot, 2>& LiveRetarget::standing() const {
  return state_->stance.standing();
}

std::span<const RigidTransform> LiveRetarget::world_from_joint() const {
  return state_->avatar_world;
}

}  // namespace marey::retarget
