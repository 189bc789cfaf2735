// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/step/character_player.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/smooth_step.h"
#include "retarget/body/normalized_skeleton.h"
#include "retarget/body/rotation_from_t_pose.h"

namespace marey::engine {
namespace {

constexpr std::array<const char*, 2> kSupportIds{"support left", "support right"};
constexpr std::array<const char*, 2> kReachIds{"reach left", "reach right"};
constexpr std::array<const char*, 2> kTurnIds{"reach turn left", "reach turn right"};
constexpr std::array<HumanBone, 2> kFootBones{HumanBone::kLeftFoot,
                                              HumanBone::kRightFoot};
constexpr double kLevelFade_s = 0.2;

Constraint support_of(std::size_t side) {
  Constraint support;
  support.id = kSupportIds[side];
  support.point.segment = name(kFootBones[side]);
  Support goal;
  goal.footprint_in_world = glm::dvec3(0.0);
  goal.world_from_t_pose = glm::dquat(1.0, 0.0, 0.0, 0.0);
  support.goal = goal;
  return support;
}

}  // namespace

Result<CharacterPlayer> CharacterPlayer::make(std::shared_ptr<const MotionBase> base,
                                              CharacterSpec spec) {
  if (!spec.map.limbs[0] || !spec.map.limbs[1]) {
    return bad_input("character \"" + spec.character.name + "\"",
                     "the body has no complete arms",
                     "use a body with shoulders, elbows and wrists");
  }
  ConstraintSet constraints;
  constraints.constraints = {support_of(0), support_of(1)};
  if (spec.reaches) {
    for (const int side : {0, 1}) {
      for (Constraint& hand :
           reach_constraints(spec.character.skeleton, spec.map, side)) {
        constraints.constraints.push_back(std::move(hand));
      }
    }
  }
  for (const Constraint& constraint : spec.constraints.constraints) {
    for (const char* id : {kSupportIds[0],
                           kSupportIds[1],
                           kReachIds[0],
                           kReachIds[1],
                           kTurnIds[0],
                           kTurnIds[1]}) {
      if (constraint.id != id) continue;
      return bad_input("character \"" + spec.character.name + "\"",
                       "the constraint \"" + constraint.id + "\" has an id of the engine",
                       "give it another id");
    }
    constraints.constraints.push_back(constraint);
  }
  retarget::AdaptOptions options = spec.adapt;
  if (spec.level == DetailLevel::kKinetic) {
    options.balance = retarget::BalanceMode::kHorizontal;
  }
  auto adapter = retarget::Adapter::make(spec.character, constraints, options);
  if (!adapter) return adapter.error();
  return CharacterPlayer(std::move(base), std::move(spec), *std::move(adapter));
}

CharacterPlayer::CharacterPlayer(std::shared_ptr<const MotionBase> base,
                                 CharacterSpec spec,
                                 retarget::Adapter adapter)
    : character_(std::make_shared<const Character>(std::move(spec.character))),
      map_(std::make_shared<const retarget::BodyMap>(std::move(spec.map))),
      blend_(
          std::move(base), make_rig(character_->skeleton, *map_), spec.start, spec.blend),
      foot_options_(spec.feet),
      level_(spec.level),
      activation_(spec.level == DetailLevel::kBlended ? 0.0 : 1.0),
      adapter_(std::make_unique<retarget::Adapter>(std::move(adapter))),
      world_from_joint_(character_->skeleton.joints.size()),
      reference_(rest_pose(character_->skeleton)),
      pose_(reference_) {
  for (std::size_t side = 0; side < 2; ++side) {
    supports_[side] = adapter_->constraint(kSupportIds[side]);
    reach_handles_[2 * side] = adapter_->constraint(kReachIds[side]);
    reach_handles_[2 * side + 1] = adapter_->constraint(kTurnIds[side]);
  }
}

std::span<const RigidTransform> CharacterPlayer::world_from_joint() const {
  if (is_adapted_) return adapter_->world_from_joint();
  return world_from_joint_;
}

void CharacterPlayer::expand() {
  to_normalized(posture_, blend_.base().layout(), root_, map_->leg_length_m, normalized_);
  retarget::expand(
      normalized_, character_->skeleton, *map_, world_from_joint_, reference_);
}

void CharacterPlayer::reach(ReachPlayer reach) {
  const std::size_t side = static_cast<std::size_t>(reach.side());
  if (throws_[side]) {
    throws_[side]->drop(
        time_s_, *reach_handles_[2 * side], *reach_handles_[2 * side + 1]);
  }
  reaches_[side] = std::move(reach);
}

ReachPlayer* CharacterPlayer::reaching(int side) {
  auto& reach = reaches_[static_cast<std::size_t>(side)];
  return reach ? &*reach : nullptr;
}

void CharacterPlayer::play_throw(ThrowPlayer made) {
  const std::size_t side = static_cast<std::size_t>(made.side());
  if (throws_[side])
    throws_[side]->drop(
        time_s_, *reach_handles_[2 * side], *reach_handles_[2 * side + 1]);
  throws_[side] = std::move(made);
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
                           *adapter_,
                           supports_,
                           *reach_handles_[2 * side],
                           *reach_handles_[2 * side + 1]};
    throws_[side]->step(stage);
    if (throws_[side]->holds()) reaches_[side].reset();
  }
}

void CharacterPlayer::steer_root(double time_s, double step_s) {
  if (!steer_) return;
  std::array<bool, 2> bears{};
  for (std::size_t side = 0; side < 2; ++side)
    bears[side] = bore_[side][0] || bore_[side][1];
  steer_->step(time_s, step_s, ankle_xz_m_, bears, blend_);
}

void CharacterPlayer::move_hands(double time_s, double step_s) {
  for (std::size_t side = 0; side < 2; ++side) {
    if (!reaches_[side]) continue;
    if (!reaches_[side]->step(time_s,
                              step_s,
                              blend_,
                              world_from_joint_,
                              *reach_handles_[2 * side],
                              *reach_handles_[2 * side + 1])) {
      reaches_[side].reset();
    }
  }
}

void CharacterPlayer::step(double time_s, double step_s) {
  time_s_ = time_s;
  if (!blend_.step(time_s, step_s)) return;
  steer_root(time_s, step_s);
  root_ = blend_.root();
  report_.transition = blend_.report();
  const double change = step_s / kLevelFade_s;
  activation_ = std::clamp(
      activation_ + (level_ == DetailLevel::kBlended ? -change : change), 0.0, 1.0);
  is_adapted_ = activation_ > 0.0;
  posture_ = blend_.posture();
  if (!is_adapted_) {
    expand();
    pose_ = reference_;
    forget_feet();
    return;
  }
  hold_feet(time_s, step_s);
  expand();
  // Hands plan on the blend, whose hips the feet have not lowered.
  const double drop_m = blend_hips_in_world_.y - reference_.root_in_world.y;
  for (RigidTransform& joint : world_from_joint_) joint.translation.y += drop_m;
  // Before the feet, because a throw poses the body at other times.
  move_throws(time_s, step_s);
  lead_feet();
  move_hands(time_s, step_s);
  report_.adapt = adapter_->adapt(reference_, time_s, pose_);
  const std::size_t hips = index(map_->hips());
  shift_.hips_m = adapter_->world_from_joint()[hips].translation - blend_hips_in_world_;
}

}  // namespace marey::engine
