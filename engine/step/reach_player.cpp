// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/step/reach_player.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/clips/sample_clip.h"
#include "engine/step/rehearsal.h"

#include "retarget/body/normalized_skeleton.h"
#include "retarget/body/rotation_from_t_pose.h"

namespace marey::engine {
namespace {

constexpr double kNever_s = 1e9;  // Started by the caller.

JointIndex hand_of(const retarget::BodyMap& map, int side) {
  return map.limbs[static_cast<std::size_t>(side)]->end;
}

}  // namespace

std::array<Constraint, 2> reach_constraints(const Skeleton& skeleton,
                                            const retarget::BodyMap& map,
                                            int side) {
  const std::string hand = side == 0 ? "left" : "right";
  const std::string segment(
      name(side == 0 ? HumanBone::kLeftHand : HumanBone::kRightHand));
  const retarget::LimbMap& arm = *map.limbs[static_cast<std::size_t>(side)];
  Constraint point;
  point.id = "reach " + hand;
  point.point = {segment,
                 reach_lengths(skeleton, map, side).palm_m * arm.along_in_t_pose};
  point.goal = DistanceToPoint{};
  point.activation.start_s = kNever_s;
  Constraint turn;
  turn.id = "reach turn " + hand;
  turn.point.segment = segment;
  turn.goal = SegmentOrientation{};
  turn.importance = 0.5;
  turn.activation.start_s = kNever_s;
  return {point, turn};
}

ReachPlayer::ReachPlayer(const Skeleton& skeleton, const retarget::BodyMap& map)
    : skeleton_(&skeleton), map_(&map), joints_(skeleton.joints.size()) {
  pose_.parent_from_joint.resize(skeleton.joints.size());
}

Result<ReachPlayer> ReachPlayer::make(const MotionBase& base,
                                      ActionId action,
                                      std::size_t clip,
                                      const ReachWish& wish,
                                      const Skeleton& skeleton,
                                      const retarget::BodyMap& map) {
  if (const Status target = check_target(wish.target); !target) return target.error();
  ReachPlayer out(skeleton, map);
  const auto& notes = base.clip(clip).notes;
  const auto event =
      std::find_if(notes.begin(), notes.end(), [&](const Annotation& note) {
        return note.text == wish.arrive;
      });
  if (event == notes.end()) {
    return bad_input("action \"" + wish.action.clip + "\"",
                     "the clip has no event \"" + wish.arrive + "\"",
                     "add it with the operation event of marey edit");
  }
  out.action_ = action;
  out.event_s_ = event->start_s;
  out.wish_ = wish;
  out.lengths_ = reach_lengths(skeleton, map, wish.side);
  out.palm_in_t_pose_ = out.lengths_.palm_m *
                        map.limbs[static_cast<std::size_t>(wish.side)]->along_in_t_pose;
  return out;
}

Status ReachPlayer::aim(const ReachTarget& target) {
  if (const Status good = check_target(target); !good) return good.error();
  wish_.target = target;
  return Done{};
}

RigidTransform ReachPlayer::palm(std::span<const RigidTransform> world_from_joint) const {
  const JointIndex hand = hand_of(*map_, wish_.side);
  RigidTransform out;
  out.rotation = retarget::rotation_from_t_pose(*map_, world_from_joint, hand);
  out.translation =
      world_from_joint[index(hand)].translation + out.rotation * palm_in_t_pose_;
  return out;
}

RigidTransform ReachPlayer::predicted_palm(double now_s,
                                           double time_s,
                                           const BlendPlayer& blend) {
  BlendPosture posture;
  RootPlace root;
  if (!blend.predict(now_s, time_s, posture, root)) return palm_before_;
  to_normalized(posture, blend.base().layout(), root, map_->leg_length_m, normalized_);
  retarget::expand(normalized_, *skeleton_, *map_, joints_, pose_);
  RigidTransform out = palm(joints_);
  out.translation.y += lift_m_;
  return out;
}

void ReachPlayer::add_companion(ActionId action, double event_s) {
  if (companion_count_ == companions_.size()) return;
  companions_[companion_count_++] = {action, event_s};
}

// Plays the clips so that their events happen at a time.
void ReachPlayer::put_off(double time_s,
                          double step_s,
                          double arrive_s,
                          BlendPlayer& blend) {
  const auto replan = [&](ActionId id, double event_s) {
    PhaseWarp* warp = blend.warp(id);
    if (warp == nullptr) return;
    const WarpKnot knot{arrive_s, event_s};
    (void)warp->replan(time_s, {&knot, 1}, blend.find(id)->rate, step_s);
  };
  replan(action_, event_s_);
  for (std::size_t i = 0; i < companion_count_; ++i) {
    replan(companions_[i].action, companions_[i].event_s);
  }
}

ReachFeasibility ReachPlayer::ask(const BlendPlayer& blend, const Action& action) {
  const MotionClip& clip = blend.base().clip(action.clip);
  const double entry_s = action.entry_s.value_or(0.0);
  const RootPlace start = path_at(clip, entry_s);
  const auto palm_at = [&](double source_s) {
    BlendPosture posture;
    sample_clip(clip, source_s, posture);
    RootPlace by = relative(start, path_at(clip, source_s));
    by.x_m *= map_->leg_length_m;
    by.z_m *= map_->leg_length_m;
    to_normalized(posture,
                  blend.base().layout(),
                  moved(blend.root(), by),
                  map_->leg_length_m,
                  normalized_);
    retarget::expand(normalized_, *skeleton_, *map_, joints_, pose_);
    return palm(joints_);
  };
  constexpr double kStep_s = 1.0 / 60.0;
  ReachQuestion question;
  const RigidTransform before = palm_at(event_s_ - kStep_s);
  const RigidTransform after = palm_at(event_s_ + kStep_s);
  question.clip_at_arrival = hand_motion(before, palm_at(event_s_), after, kStep_s);
  const retarget::LimbMap& arm = *map_->limbs[static_cast<std::size_t>(wish_.side)];
  question.hips_in_world = joints_[index(map_->hips())].translation;
  question.shoulder_in_world = joints_[index(arm.upper)].translation;
  question.clip_remaining_s = std::max(0.0, event_s_ - entry_s) / action.rate;
  question.target = wish_.target;
  return ask_reach(lengths_, wish_.share, question, wish_.options);
}

bool ReachPlayer::step(double time_s,
                       double step_s,
                       BlendPlayer& blend,
                       std::span<const RigidTransform> world_from_joint,
                       double lift_m,
                       retarget::Adapter::Handle point,
                       retarget::Adapter::Handle turn) {
  const Action* action = blend.find(action_);
  if (action != nullptr && action->phase == ActionPhase::kQueued) return true;
  lift_m_ = lift_m;
  if (action == nullptr || action->phase == ActionPhase::kFadingOut) {
    for (std::size_t i = 0; i < companion_count_; ++i) {
      (void)blend.stop(companions_[i].action);
    }
  }
  const RigidTransform now = palm(world_from_joint);
  PhaseWarp* warp = blend.warp(action_);
  if (!has_started_) {
    if (warp == nullptr) return false;
    palm_before_ = predicted_palm(time_s, time_s - step_s, blend);
  }
  ReachInput input;
  input.time_s = time_s;
  input.step_s = step_s;
  input.clip_now = hand_motion(
      palm_before_, now, predicted_palm(time_s, time_s + step_s, blend), step_s);
  palm_before_ = now;
  if (warp == nullptr || action->phase == ActionPhase::kFadingOut) course_.release();
  const double arrive_s =
      warp == nullptr ? time_s : event_time_s(*warp, time_s, event_s_);
  input.clip_at_arrival = input.clip_now;
  if (arrive_s > time_s) {
    input.clip_at_arrival = hand_motion(predicted_palm(time_s, arrive_s - step_s, blend),
                                        predicted_palm(time_s, arrive_s, blend),
                                        predicted_palm(time_s, arrive_s + step_s, blend),
                                        step_s);
  }
  input.arrive_s = arrive_s;
  input.clip_remaining_s =
      warp == nullptr ? 0.0 : std::max(0.0, event_s_ - warp->source_s(time_s));
  input.target = wish_.target;
  const retarget::LimbMap& arm = *map_->limbs[static_cast<std::size_t>(wish_.side)];
  input.within = reach_ball(lengths_,
                            wish_.share,
                            world_from_joint[index(map_->hips())].translation,
                            world_from_joint[index(arm.upper)].translation,
                            wish_.target.p_in_world);
  if (!has_started_) {
    course_.start(time_s, input.clip_now, wish_.options);
    point.start(time_s);
    has_started_ = true;
  }
  last_ = course_.step(input);
  if (last_.phase == ReachPhase::kDone) {
    point.stop(time_s);
    turn.stop(time_s);
    return false;
  }
  if (warp != nullptr && last_.arrive_s > arrive_s + 1e-3) {
    put_off(time_s, step_s, last_.arrive_s, blend);
  }
  point.set_target(last_.hand.p_in_world);
  if (last_.turns) {
    turn.set_orientation(last_.hand.world_from_hand);
    if (turn.outcome().activation <= 0.0) turn.start(time_s);
  }
  return true;
}

}  // namespace marey::engine
