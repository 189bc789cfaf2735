// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live_chain/live_handles.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/live_chain/body_handles.h"
#include "core/base/assert.h"
#include "retarget/character/make_character.h"
#include "retarget/constraints/resolve_segment.h"

namespace marey::app {

Result<LiveHandles> LiveHandles::make(const std::string& name, const Skeleton& avatar) {
  const auto map = retarget::map_body(avatar);
  if (!map) return map.error();
  const auto character = retarget::make_character(name, avatar, *map);
  if (!character) return character.error();
  const std::vector<BodyHandle> handles = body_handles(avatar);
  const std::vector<Constraint> supports = foot_supports(avatar, kSupportFade_s);
  ConstraintSet set;
  for (const BodyHandle& handle : handles) {
    set.constraints.push_back(handle_constraint(handle, kFade_s));
  }
  set.constraints.insert(set.constraints.end(), supports.begin(), supports.end());
  auto adapter = retarget::Adapter::make(*character, set, {});
  if (!adapter) return adapter.error();

  LiveHandles out(*std::move(adapter));
  const auto at_rest = world_from_joints(avatar, rest_pose(avatar));
  for (const BodyHandle& handle : handles) {
    out.held_.push_back({*out.adapter_.constraint(handle.id)});
    out.states_.push_back(
        {handle.id, handle.joint, false, at_rest[index(handle.joint)].translation});
  }
  for (const Constraint& support : supports) {
    out.feet_.push_back({*out.adapter_.constraint(support.id),
                         *retarget::resolve_segment(avatar, support.point.segment),
                         support.point.segment == "leftFoot" ? 0U : 1U});
  }
  out.adapted_ = rest_pose(avatar);
  return out;
}

void LiveHandles::ask(const HandleRequest& request) {
  const auto found = std::ranges::find(states_, request.id, &HandleState::id);
  if (found == states_.end()) return;
  Held& held = held_[static_cast<std::size_t>(found - states_.begin())];
  if (request.action == HandleAction::kStop) {
    if (found->active) held.handle.stop(time_s_);
    found->active = false;
    return;
  }
  // kStart holds the joint at its current position.
  if (request.action != HandleAction::kStart) found->p_in_world = request.p_in_world;
  if (found->active) return;
  found->active = true;
  held.handle.start(time_s_);
  busy_ = true;
}

bool LiveHandles::any_active() const {
  return std::ranges::any_of(held_, [this](const Held& held) {
    const auto i = static_cast<std::size_t>(&held - held_.data());
    return states_[i].active || held.handle.outcome().activation > 0.0;
  });
}

bool LiveHandles::is_dragged(JointIndex joint) const {
  return std::ranges::any_of(states_, [joint](const HandleState& state) {
    return state.active && state.joint == joint;
  });
}

/// Moves the filtered targets smoothly towards the requested ones.
void LiveHandles::follow(double since_last_s) {
  const double share = 1.0 - std::exp(-since_last_s / kFollow_s);
  for (std::size_t i = 0; i < held_.size(); ++i) {
    Held& held = held_[i];
    if (states_[i].active) {
      const glm::dvec3 wanted = states_[i].p_in_world;
      held.target_in_world =
          held.has_target ? held.target_in_world + share * (wanted - held.target_in_world)
                          : wanted;
      held.has_target = true;
      held.handle.set_target(held.target_in_world);
    }
  }
}

/// Keeps supporting feet at their position in the pose, so that a dragged joint does not
/// move them.
void LiveHandles::stand(std::span<const RigidTransform> world_from_joint,
                        const std::array<retarget::StandingFoot, 2>& standing) {
  const bool is_held = any_active();
  // No handle has an effect yet: the supports must be active before the first handle.
  const bool begins = std::ranges::all_of(
      held_, [](const Held& held) { return held.handle.outcome().activation == 0.0; });
  for (Foot& foot : feet_) {
    const retarget::StandingFoot& parts = standing[foot.side];
    const bool stands = is_held && (parts.heel || parts.ball) && !is_dragged(foot.joint);
    foot.support.set_target(world_from_joint[index(foot.joint)].translation);
    if (stands != foot.stands) {
      if (stands) {
        foot.support.start(begins ? time_s_ - kSupportFade_s : time_s_);
      } else {
        foot.support.stop(time_s_);
      }
    }
    foot.stands = stands;
  }
}

/// Updates the states: inactive handles are at the positions of their joints.
void LiveHandles::update_states() {
  const std::span<const RigidTransform> joints = adapter_.world_from_joint();
  busy_ = false;
  for (std::size_t i = 0; i < held_.size(); ++i) {
    const bool fades = held_[i].handle.outcome().activation > 0.0;
    if (!states_[i].active) {
      states_[i].p_in_world = joints[index(states_[i].joint)].translation;
      held_[i].has_target = held_[i].has_target && fades;
    }
    busy_ = busy_ || states_[i].active || fades;
  }
  for (const Foot& foot : feet_) {
    busy_ = busy_ || foot.stands || foot.support.outcome().activation > 0.0;
  }
}

void LiveHandles::step(std::span<const RigidTransform> world_from_joint,
                       const std::array<retarget::StandingFoot, 2>& standing,
                       double since_last_s,
                       Pose& posture) {
  MAREY_ASSERT(since_last_s > 0.0);
  time_s_ += since_last_s;
  if (!busy_) {
    for (HandleState& state : states_) {
      state.p_in_world = world_from_joint[index(state.joint)].translation;
    }
    return;
  }
  follow(since_last_s);
  stand(world_from_joint, standing);
  (void)adapter_.adapt(posture, time_s_, adapted_);
  update_states();
  if (!busy_) return;  // All handles have faded out.
  posture.root_in_world = adapted_.root_in_world;
  std::ranges::copy(adapted_.parent_from_joint, posture.parent_from_joint.begin());
}

}  // namespace marey::app
