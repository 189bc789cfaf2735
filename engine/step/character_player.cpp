// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/step/character_player.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/step/landing.h"

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
      ground_(std::move(spec.floor)),
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

FootReference CharacterPlayer::foot_reference(std::size_t side, double time_s) const {
  const JointIndex joint = *map_->joint_of[index(kFootBones[side])];
  FootReference out;
  out.ankle_in_world = world_from_joint_[index(joint)].translation;
  out.world_from_t_pose = retarget::rotation_from_t_pose(*map_, world_from_joint_, joint);
  out.heel_bears = bore_[side][0];
  out.ball_bears = bore_[side][1];
  if (!out.heel_bears && !out.ball_bears) {
    out.landing = next_landing(blend_, side, time_s, foot_options_.land_s);
    if (out.landing) out.landing->ankle_in_world.y += floor_.lift_m();
  }
  return out;
}

void CharacterPlayer::meet_floor(double step_s) {
  std::optional<double> sole_m;
  for (std::size_t side = 0; side < 2; ++side) {
    for (std::size_t part = 0; part < 2; ++part) {
      bool& bears = bore_[side][part];
      bears = blend_.bears()[2 * side + part] > (bears ? kBearsUntil : kBearsAbove);
    }
    if (!bore_[side][0] && !bore_[side][1]) continue;
    const JointIndex joint = *map_->joint_of[index(kFootBones[side])];
    const retarget::FootMap& foot = map_->feet[side];
    double height_m = world_from_joint_[index(joint)].translation.y - foot.ankle_height_m;
    if (!bore_[side][0]) {
      const glm::dquat turn =
          retarget::rotation_from_t_pose(*map_, world_from_joint_, joint);
      height_m += (turn * foot.ball_from_ankle_in_t_pose).y + foot.ankle_height_m -
                  foot.ball_height_m;
    }
    sole_m = std::min(sole_m.value_or(height_m), height_m);
  }
  const double lift_m =
      smooth_step(activation_) *
      floor_.step(sole_m, foot_options_.max_height_legs * map_->leg_length_m, step_s);
  for (RigidTransform& joint : world_from_joint_) joint.translation.y += lift_m;
  reference_.root_in_world.y += lift_m;
}

void CharacterPlayer::hold_feet(double time_s, double step_s) {
  const double share = smooth_step(activation_);
  glm::dvec2 away_m(0.0);
  double standing = 0.0;
  for (std::size_t side = 0; side < 2; ++side) {
    const FootReference reference = foot_reference(side, time_s);
    const FootHold::Place place = feet_[side].step(
        reference, map_->feet[side], blend_.rig().leg_length_m, step_s, foot_options_);
    report_.stands[side] = feet_[side].holds();
    ankle_xz_m_[side] = {place.ankle_in_world.x, place.ankle_in_world.z};
    StandingFoot& now = shift_.feet[side];
    now.stands = report_.stands[side];
    now.ankle_in_world = glm::mix(reference.ankle_in_world, place.ankle_in_world, share);
    now.world_from_t_pose = glm::normalize(
        glm::slerp(reference.world_from_t_pose, place.world_from_t_pose, share));
    now.from_reference_m = now.ankle_in_world - reference.ankle_in_world;
    supports_[side]->set_target(now.ankle_in_world);
    supports_[side]->set_orientation(now.world_from_t_pose);
    if (report_.stands[side]) {
      away_m += ankle_xz_m_[side] -
                glm::dvec2(reference.ankle_in_world.x, reference.ankle_in_world.z);
      standing += 1.0;
    }
  }
  // Acts on the next step.
  const double pulled = share * blend_.anchored() / std::max(1.0, standing);
  const glm::dvec2 pull_m = pull_.step(pulled * away_m, step_s);
  RootPlace root = blend_.root();
  root.x_m += pull_m.x;
  root.z_m += pull_m.y;
  blend_.place(root);
}

void CharacterPlayer::ride_floor(double time_s, double step_s) {
  if (ground_ == nullptr) return;
  std::array<FloorRide::Foot, 2> feet{};
  for (std::size_t side = 0; side < 2; ++side) {
    const StandingFoot& foot = shift_.feet[side];
    feet[side] = {foot.stands, foot.ankle_in_world, map_->feet[side].ankle_height_m};
  }
  const auto shifts = ride_.step(*ground_, time_s, step_s, feet);
  const double share = smooth_step(activation_);
  const glm::dvec3 body_m = 0.5 * share * (shifts[0].moved_m + shifts[1].moved_m);
  for (RigidTransform& joint : world_from_joint_) joint.translation += body_m;
  reference_.root_in_world += body_m;
  for (std::size_t side = 0; side < 2; ++side) {
    StandingFoot& foot = shift_.feet[side];
    foot.ankle_in_world += share * shifts[side].moved_m;
    foot.from_reference_m += share * shifts[side].moved_m - body_m;
    foot.world_from_t_pose = glm::normalize(
        glm::slerp(glm::dquat(1.0, 0.0, 0.0, 0.0), shifts[side].turn, share) *
        foot.world_from_t_pose);
    supports_[side]->set_target(foot.ankle_in_world);
    supports_[side]->set_orientation(foot.world_from_t_pose);
    report_.floor_moved_m[side] = shifts[side].carried_m;
  }
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
  report_.transition = blend_.report();
  to_normalized(blend_.posture(),
                blend_.base().layout(),
                blend_.root(),
                map_->leg_length_m,
                normalized_);
  retarget::expand(
      normalized_, character_->skeleton, *map_, world_from_joint_, reference_);
  const double change = step_s / kLevelFade_s;
  activation_ = std::clamp(
      activation_ + (level_ == DetailLevel::kBlended ? -change : change), 0.0, 1.0);
  is_adapted_ = activation_ > 0.0;
  if (!is_adapted_) {
    pose_ = reference_;
    feet_[0].reset();
    feet_[1].reset();
    floor_.reset();
    report_.stands = {};
    return;
  }
  meet_floor(step_s);
  // Before the feet, because a throw poses the body at other times.
  move_throws(time_s, step_s);
  hold_feet(time_s, step_s);
  ride_floor(time_s, step_s);
  move_hands(time_s, step_s);
  report_.adapt = adapter_->adapt(reference_, time_s, pose_);
  const std::size_t hips = index(map_->hips());
  shift_.hips_m = adapter_->world_from_joint()[hips].translation -
                  world_from_joint_[hips].translation;
}

}  // namespace marey::engine
