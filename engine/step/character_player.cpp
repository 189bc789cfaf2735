// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/step/character_player.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/smooth_step.h"
#include "retarget/body/normalized_skeleton.h"
#include "retarget/body/rotation_from_t_pose.h"
#include "retarget/constraints/resolve_segment.h"

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

// Points of the constraints that follow: at a place, without a distance.
std::vector<FollowPoint> follow_points(const ConstraintSet& constraints,
                                       const Skeleton& skeleton,
                                       const retarget::BodyMap& map) {
  std::vector<FollowPoint> out;
  for (const Constraint& constraint : constraints.constraints) {
    const auto* goal = std::get_if<DistanceToPoint>(&constraint.goal);
    if (goal == nullptr || goal->distance_m != 0.0) continue;
    const auto joint = retarget::resolve_segment(skeleton, constraint.point.segment);
    if (!joint || map.joints[index(*joint)].role == retarget::JointRole::kFree) continue;
    out.push_back({constraint.id, *joint, constraint.point.offset_in_t_pose});
  }
  return out;
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
  auto reserved = ClipConstraints::reserve(*base, spec.constrained_clips);
  if (!reserved) return reserved.error();
  std::vector<FollowPoint> points =
      follow_points(constraints, spec.character.skeleton, spec.map);
  for (Constraint& constraint : *reserved) {
    constraints.constraints.push_back(std::move(constraint));
  }
  retarget::AdaptOptions options = spec.adapt;
  if (spec.level == DetailLevel::kKinetic) {
    options.balance = retarget::BalanceMode::kHorizontal;
  }
  auto adapter = retarget::Adapter::make(spec.character, constraints, options);
  if (!adapter) return adapter.error();
  return CharacterPlayer(
      std::move(base), std::move(spec), std::move(points), *std::move(adapter));
}

CharacterPlayer::CharacterPlayer(std::shared_ptr<const MotionBase> base,
                                 CharacterSpec spec,
                                 std::vector<FollowPoint> points,
                                 retarget::Adapter adapter)
    : character_(std::make_shared<const Character>(std::move(spec.character))),
      map_(std::make_shared<const retarget::BodyMap>(std::move(spec.map))),
      blend_(
          std::move(base), make_rig(character_->skeleton, *map_), spec.start, spec.blend),
      foot_options_(spec.feet),
      level_(spec.level),
      activation_(spec.level == DetailLevel::kBlended ? 0.0 : 1.0),
      adapter_(std::make_unique<retarget::Adapter>(std::move(adapter))),
      points_(std::move(points)),
      ground_(std::move(spec.floor)),
      world_from_joint_(character_->skeleton.joints.size()),
      reference_(rest_pose(character_->skeleton)),
      pose_(reference_) {
  // Questions and targets before the first step take the rest pose at the start.
  Pose at_start = reference_;
  at_start.root_in_world.x = blend_.root().x_m;
  at_start.root_in_world.z = blend_.root().z_m;
  at_start.parent_from_joint[0] =
      glm::angleAxis(blend_.root().heading_rad, glm::dvec3(0.0, 1.0, 0.0)) *
      at_start.parent_from_joint[0];
  world_from_joint_ = world_from_joints(character_->skeleton, at_start);
  shown_joints_ = world_from_joint_;
  for (std::size_t side = 0; side < 2; ++side) {
    supports_[side] = adapter_->constraint(kSupportIds[side]);
    reach_handles_[2 * side] = adapter_->constraint(kReachIds[side]);
    reach_handles_[2 * side + 1] = adapter_->constraint(kTurnIds[side]);
  }
  follows_.reserve(points_.size());
  clip_constraints_.attach(blend_.base(), spec.constrained_clips, *adapter_);
}

std::span<const RigidTransform> CharacterPlayer::world_from_joint() const {
  if (is_adapted_) return adapter().world_from_joint();
  return world_from_joint_;
}

void CharacterPlayer::expand() {
  retarget::NormalizedPose normalized;
  to_normalized(posture_, blend_.base().layout(), root_, map_->leg_length_m, normalized);
  retarget::expand(
      normalized, character_->skeleton, *map_, world_from_joint_, reference_);
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
  blend_hips_in_world_ += body_m;
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

void CharacterPlayer::join(retarget::Crowd& crowd, std::size_t member) {
  adapter_.reset();
  crowd_ = &crowd;
  member_ = member;
}

void CharacterPlayer::step(double time_s, double step_s) {
  if (!prepare_step(time_s, step_s)) return;
  report_.adapt = adapter().adapt(reference_, time_s, pose_);
  finish_step();
}

retarget::CrowdJob CharacterPlayer::adapt_job() {
  return {member_, &reference_, &pose_, &report_.adapt};
}

bool CharacterPlayer::prepare_step(double time_s, double step_s) {
  time_s_ = time_s;
  if (!blend_.step(time_s, step_s)) return false;
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
    keep_shown();
    return false;
  }
  hold_feet(time_s, step_s);
  expand();
  // Hands plan on the blend, whose hips the feet have not lowered.
  const double drop_m = blend_hips_in_world_.y - reference_.root_in_world.y;
  for (RigidTransform& joint : world_from_joint_) joint.translation.y += drop_m;
  // Before the feet, because a throw poses the body at other times.
  move_throws(time_s, step_s);
  lead_feet();
  ride_floor(time_s, step_s);
  move_hands(time_s, step_s);
  move_follows(time_s, step_s);
  clip_constraints_.step(time_s, map_->leg_length_m, blend_);
  return true;
}

void CharacterPlayer::finish_step() {
  const std::size_t hips = index(map_->hips());
  shift_.hips_m = adapter().world_from_joint()[hips].translation - blend_hips_in_world_;
  keep_shown();
}

void CharacterPlayer::keep_shown() {
  if (points_.empty()) return;
  const auto joints = world_from_joint();
  shown_joints_.assign(joints.begin(), joints.end());
}

}  // namespace marey::engine
