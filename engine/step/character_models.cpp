// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "engine/step/character_player.h"
#include <glm/geometric.hpp>

// The motion models of a character: walks to goals, reaches, throws, followed points.

namespace marey::engine {
namespace {

constexpr std::array<const char*, 2> kPalmIds{"reach left", "reach right"};

}  // namespace

void CharacterPlayer::reach(ReachPlayer reach) {
  const std::size_t side = static_cast<std::size_t>(reach.side());
  drop_follow(side);
  if (throws_[side]) {
    throws_[side]->drop(
        time_s_, *reach_handles_[2 * side], *reach_handles_[2 * side + 1]);
  }
  reaches_[side] = std::make_unique<ReachPlayer>(std::move(reach));
}

ReachPlayer* CharacterPlayer::reaching(int side) {
  auto& reach = reaches_[static_cast<std::size_t>(side)];
  return reach ? &*reach : nullptr;
}

void CharacterPlayer::play_throw(ThrowPlayer made) {
  const std::size_t side = static_cast<std::size_t>(made.side());
  drop_follow(side);
  if (throws_[side]) {
    throws_[side]->drop(
        time_s_, *reach_handles_[2 * side], *reach_handles_[2 * side + 1]);
  }
  throws_[side] = std::make_unique<ThrowPlayer>(std::move(made));
}

const ThrowPlayer* CharacterPlayer::throwing(int side) const {
  const auto& made = throws_[static_cast<std::size_t>(side)];
  return made ? &*made : nullptr;
}

ThrowPlayer* CharacterPlayer::throwing(int side) {
  return const_cast<ThrowPlayer*>(std::as_const(*this).throwing(side));
}

void CharacterPlayer::move_throws(double time_s, double step_s) {
  for (std::size_t side = 0; side < 2; ++side) {
    if (!throws_[side] || throws_[side]->is_over()) continue;
    const ThrowStage stage{time_s,
                           step_s,
                           blend_,
                           world_from_joint_,
                           shift_,
                           adapter(),
                           supports_,
                           *reach_handles_[2 * side],
                           *reach_handles_[2 * side + 1]};
    throws_[side]->step(stage);
    if (throws_[side]->holds()) reaches_[side].reset();
  }
}

void CharacterPlayer::steer_root(double time_s, double step_s) {
  steered_rad_ = 0.0;
  if (!steer_) return;
  std::array<bool, 2> bears{};
  for (std::size_t side = 0; side < 2; ++side)
    bears[side] = bore_[side][0] || bore_[side][1];
  const double before_rad = blend_.root().heading_rad;
  steer_->step(time_s, step_s, ankle_xz_m_, bears, blend_);
  steered_rad_ = blend_.root().heading_rad - before_rad;
}

void CharacterPlayer::move_hands(double time_s, double step_s) {
  for (std::size_t side = 0; side < 2; ++side) {
    if (!reaches_[side]) continue;
    if (!reaches_[side]->step(time_s,
                              step_s,
                              blend_,
                              world_from_joint_,
                              shift_.lift_m,
                              *reach_handles_[2 * side],
                              *reach_handles_[2 * side + 1])) {
      reaches_[side].reset();
    }
  }
}

Result<std::shared_ptr<const JumpBody>> CharacterPlayer::jump_body(std::size_t clip,
                                                                   int jump) {
  for (const PreparedJump& prepared : jumps_) {
    if (prepared.clip == clip && prepared.jump == jump) return prepared.body;
  }
  const MotionBase& base = blend_.base();
  auto made = JumpBody::make(base.clip(clip), base.layout(), *character_, *map_, jump);
  if (!made) return made.error();
  jumps_.push_back({clip, jump, *made});
  return *std::move(made);
}

std::size_t CharacterPlayer::add_clip(MotionClip clip) {
  const MotionBase& base = blend_.base();
  const std::size_t first = base.clips().size();
  const auto is_played = [&](std::size_t slot) {
    const auto actions = blend_.actions();
    return std::any_of(actions.begin(), actions.end(), [&](const Action& action) {
      return !action.is_live && action.clip == first + slot;
    });
  };
  std::size_t slot = 0;
  while (slot < base.own_count() && is_played(slot)) ++slot;
  blend_.set_base(base.with_own(slot, std::move(clip)));
  return first + slot;
}

Result<FollowPlayer> CharacterPlayer::make_follow(ActionId id,
                                                  const FollowWish& wish) const {
  const auto point =
      std::find_if(points_.begin(), points_.end(), [&](const FollowPoint& p) {
        return p.id == wish.constraint;
      });
  const auto handle = adapter().constraint(wish.constraint);
  if (point == points_.end() || !handle) {
    return bad_input("follow \"" + wish.constraint + "\"",
                     "the character has no constraint of this id that leads a point to a "
                     "place",
                     "add a DistanceToPoint without a distance to "
                     "CharacterSpec::constraints, or set CharacterSpec::reaches");
  }
  return FollowPlayer::make(id, wish, *point, character_->skeleton, *map_, *handle);
}

Result<FollowFeasibility> CharacterPlayer::ask_follow(const FollowWish& wish,
                                                      double step_s) const {
  const auto made = make_follow(ActionId{}, wish);
  if (!made) return made.error();
  const glm::dvec3 target = wish.target_in_world;
  const std::span<const RigidTransform> joints = world_from_joint();
  FollowFeasibility out;
  for (std::size_t side = 0; side < 2; ++side) {
    if (wish.constraint != kPalmIds[side]) continue;
    const ReachBall ball =
        reach_ball(reach_lengths(character_->skeleton, *map_, static_cast<int>(side)),
                   ReachShare{},
                   joints[index(map_->hips())].translation,
                   joints[index(map_->limbs[side]->upper)].translation,
                   target);
    out.missing_m =
        std::max(0.0, glm::distance(target, ball.centre_in_world) - ball.radius_m);
  }
  const double away_m =
      glm::distance(posed_point(joints, *map_, made->point()), target) - out.missing_m;
  out.duration_s = follow_time_s(std::max(0.0, away_m), wish.settings);
  out.steps = static_cast<int>(std::ceil(out.duration_s / step_s - 1e-9));
  out.reachable = out.missing_m <= 1e-3;
  return out;
}

void CharacterPlayer::follow(FollowPlayer made) {
  for (std::size_t side = 0; side < 2; ++side) {
    if (made.point().id == kPalmIds[side]) drop_hand(side);
  }
  std::erase_if(follows_, [&](FollowPlayer& other) {
    if (other.point().id != made.point().id) return false;
    other.drop(time_s_);
    return true;
  });
  follows_.push_back(std::move(made));
}

const FollowPlayer* CharacterPlayer::following(ActionId id) const {
  for (const FollowPlayer& each : follows_) {
    if (each.id() == id) return &each;
  }
  return nullptr;
}

FollowPlayer* CharacterPlayer::following(ActionId id) {
  return const_cast<FollowPlayer*>(std::as_const(*this).following(id));
}

void CharacterPlayer::drop_hand(std::size_t side) {
  auto& point = *reach_handles_[2 * side];
  auto& turn = *reach_handles_[2 * side + 1];
  if (throws_[side]) throws_[side]->drop(time_s_, point, turn);
  if (reaches_[side]) {
    reaches_[side].reset();
    point.stop(time_s_);
    turn.stop(time_s_);
  }
}

void CharacterPlayer::drop_follow(std::size_t side) {
  std::erase_if(follows_, [&](FollowPlayer& each) {
    if (each.point().id != kPalmIds[side]) return false;
    each.drop(time_s_);
    return true;
  });
}

void CharacterPlayer::move_follows(double time_s, double step_s) {
  // The joints of the last step, as they were shown.
  std::erase_if(follows_, [&](FollowPlayer& each) {
    return !each.step(time_s, step_s, blend_, world_from_joint_, shown_joints_, shift_);
  });
}

}  // namespace marey::engine
