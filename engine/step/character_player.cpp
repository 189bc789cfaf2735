// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/step/character_player.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/feet/leg_reach.h"
#include "engine/step/landing.h"

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
// Hips joints are up to 0.12 legs above the hip centres, or at their height: a clip of
// one such body is that much too high on the other.
constexpr double kMaxLift_legs = 0.2;
constexpr double kMostDrop_m = 0.03;

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
  shown_joints_.resize(world_from_joint_.size());
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

FootReference CharacterPlayer::foot_reference(std::size_t side, double time_s) const {
  const JointIndex joint = *map_->joint_of[index(kFootBones[side])];
  FootReference out;
  out.ankle_in_world = world_from_joint_[index(joint)].translation;
  out.world_from_t_pose = retarget::rotation_from_t_pose(*map_, world_from_joint_, joint);
  out.heel_bears = bore_[side][0];
  out.ball_bears = bore_[side][1];
  out.steered_rad = steered_rad_;
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
  const double lift_m = smooth_step(activation_) *
                        floor_.step(sole_m, kMaxLift_legs * map_->leg_length_m, step_s);
  shift_.lift_m = lift_m;
  for (RigidTransform& joint : world_from_joint_) joint.translation.y += lift_m;
  reference_.root_in_world.y += lift_m;
}

void CharacterPlayer::hold_feet(double time_s, double step_s) {
  const double share = smooth_step(activation_);
  glm::dvec2 away_m(0.0);
  double standing = 0.0;
  std::array<FootHold::Place, 2> places{};
  for (std::size_t side = 0; side < 2; ++side) {
    const FootReference reference = foot_reference(side, time_s);
    const FootHold::Place place = feet_[side].step(
        reference, map_->feet[side], blend_.rig().leg_length_m, step_s, foot_options_);
    places[side] = place;
    report_.stands[side] = feet_[side].holds();
    ankle_xz_m_[side] = {place.ankle_in_world.x, place.ankle_in_world.z};
    shift_.feet[side].stands = report_.stands[side];
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
  lead_feet(places, share);
}

// Lowers the hips as far as the legs of standing feet need it, at most kMostDrop_m, and
// passes the feet to the adapter as far as the legs reach.
void CharacterPlayer::lead_feet(const std::array<FootHold::Place, 2>& places,
                                double share) {
  const auto hip_in_world = [&](std::size_t side) {
    return world_from_joint_[index(map_->leg(static_cast<int>(side)).upper)].translation;
  };
  double drop_m = 0.0;
  for (std::size_t side = 0; side < 2; ++side) {
    if (!report_.stands[side]) continue;
    drop_m = std::max(drop_m,
                      hips_drop_m(hip_in_world(side),
                                  places[side].ankle_in_world,
                                  map_->leg(static_cast<int>(side)).length_m()));
  }
  drop_m = share * kMostDrop_m * std::tanh(drop_m / kMostDrop_m);
  for (RigidTransform& joint : world_from_joint_) joint.translation.y -= drop_m;
  reference_.root_in_world.y -= drop_m;
  for (std::size_t side = 0; side < 2; ++side) {
    const FootHold::Place& place = places[side];
    const JointIndex joint = *map_->joint_of[index(kFootBones[side])];
    const double leg_m = map_->leg(static_cast<int>(side)).length_m();
    const glm::dvec3 hip = hip_in_world(side);
    const double reach_m =
        report_.stands[side]
            ? kMostReach * leg_m
            : leg_reach_m(glm::distance(hip, place.ankle_in_world), leg_m);
    const glm::dvec3 ankle = ankle_within(hip, place.ankle_in_world, reach_m);
    StandingFoot& now = shift_.feet[side];
    const glm::dvec3& of_blend = world_from_joint_[index(joint)].translation;
    now.ankle_in_world = glm::mix(of_blend, ankle, share);
    now.world_from_t_pose = glm::normalize(
        glm::slerp(retarget::rotation_from_t_pose(*map_, world_from_joint_, joint),
                   place.world_from_t_pose,
                   share));
    now.from_reference_m = now.ankle_in_world - of_blend;
    supports_[side]->set_target(now.ankle_in_world);
    supports_[side]->set_orientation(now.world_from_t_pose);
  }
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
  report_.transition = blend_.report();
  retarget::NormalizedPose normalized;
  to_normalized(blend_.posture(),
                blend_.base().layout(),
                blend_.root(),
                map_->leg_length_m,
                normalized);
  retarget::expand(
      normalized, character_->skeleton, *map_, world_from_joint_, reference_);
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
    keep_shown();
    return false;
  }
  meet_floor(step_s);
  // Before the feet, because a throw poses the body at other times.
  move_throws(time_s, step_s);
  hold_feet(time_s, step_s);
  ride_floor(time_s, step_s);
  move_hands(time_s, step_s);
  move_follows(time_s, step_s);
  clip_constraints_.step(time_s, map_->leg_length_m, blend_);
  return true;
}

void CharacterPlayer::finish_step() {
  const std::size_t hips = index(map_->hips());
  shift_.hips_m = adapter().world_from_joint()[hips].translation -
                  world_from_joint_[hips].translation;
  keep_shown();
}

void CharacterPlayer::keep_shown() {
  if (points_.empty()) return;
  const auto joints = world_from_joint();
  shown_joints_.assign(joints.begin(), joints.end());
}

}  // namespace marey::engine
