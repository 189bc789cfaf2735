// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "engine/engine.h"
#include <glm/geometric.hpp>

// Requests of motion models, and answers about them.

namespace marey::engine {
namespace {

int steps_in(double duration_s, double step_s) {
  return static_cast<int>(std::ceil(duration_s / step_s - 1e-9));
}

}  // namespace

Result<ActionId> Engine::play(CharacterId character, const SteerWish& wish) {
  auto action = checked(character, wish.action);
  if (!action) return action.error();
  auto steer = SteerPlayer::make(*base_, ActionId{next_action_}, action->clip, wish);
  if (!steer) return steer.error();
  player(character).steer(*std::move(steer));
  return add_action(character, *std::move(action));
}

Status Engine::aim(CharacterId character, glm::dvec2 goal_xz_m) {
  if (const auto known = check_character(character); !known) return known.error();
  if (SteerPlayer* steer = player(character).steering()) return steer->aim(goal_xz_m);
  return bad_input("character " + std::to_string(static_cast<int>(character)),
                   "it does not walk to a goal",
                   "play a walk with a goal first");
}

Result<ActionId> Engine::play(CharacterId character, const ReachWish& wish) {
  auto action = checked(character, wish.action);
  if (!action) return action.error();
  if (!wish.family.empty()) return play_family(character, *std::move(action), wish);
  auto reach = made_reach(character, *action, wish);
  if (!reach) return reach.error();
  player(character).reach(*std::move(reach));
  return add_action(character, *std::move(action));
}

Result<std::vector<FamilyAction>> Engine::chosen_family(CharacterId character,
                                                        const ReachWish& wish) const {
  if (const Status good = check_hand(character, wish.action.clip, wish.side); !good) {
    return good.error();
  }
  if (const Status good = check_target(wish.target); !good) return good.error();
  const CharacterPlayer& who = player(character);
  const RootPlace& root = who.blend().root();
  const glm::dvec3 target =
      glm::angleAxis(-root.heading_rad, glm::dvec3(0.0, 1.0, 0.0)) *
      (wish.target.p_in_world - glm::dvec3(root.x_m, 0.0, root.z_m));
  std::vector<std::string> clips{wish.action.clip};
  clips.insert(clips.end(), wish.family.begin(), wish.family.end());
  return choose_family(
      *base_, clips, wish.arrive, wish.side, target, who.character().skeleton, who.map());
}

Result<ActionId> Engine::play_family(CharacterId character,
                                     Action action,
                                     const ReachWish& wish) {
  const auto chosen = chosen_family(character, wish);
  if (!chosen) return chosen.error();
  CharacterPlayer& who = player(character);
  if (who.blend().actions().size() + chosen->size() > kMaxActions) {
    return bad_input("action \"" + wish.action.clip + "\"",
                     "the character has no room for the family of reaches",
                     "stop some of its actions first");
  }
  action.entry_s = 0.0;
  action.entry_search_s = 0.0;
  if (action.transition != TransitionKind::kCut) {
    action.transition = TransitionKind::kCrossfade;
  }
  const Action like = action;
  const auto with_share = [&](const FamilyAction& share) {
    Action out = like;
    out.clip = share.clip;
    out.weight = like.weight * static_cast<float>(share.weight);
    out.rate = std::clamp(like.rate * share.rate, kMinWarpRate, kMaxWarpRate);
    return out;
  };
  action = with_share(chosen->front());
  auto reach = made_reach(character, action, wish);
  if (!reach) return reach.error();
  const ActionId main = add_action(character, action);
  for (std::size_t i = 1; i < chosen->size(); ++i) {
    Action along = with_share((*chosen)[i]);
    along.replaces = false;
    reach->add_companion(add_action(character, along), (*chosen)[i].event_s);
  }
  who.reach(*std::move(reach));
  return main;
}

Status Engine::check_hand(CharacterId character,
                          const std::string& clip,
                          int side) const {
  if (!player(character).can_reach()) {
    return bad_input("action \"" + clip + "\"",
                     "the character was added without constraints for its hands",
                     "add it with CharacterSpec::reaches");
  }
  if (side == 0 || side == 1) return Done{};
  return bad_input("action \"" + clip + "\"",
                   "there is no hand " + std::to_string(side),
                   "give 0 for the left hand or 1 for the right one");
}

Result<ThrowPlayer> Engine::made_throw(CharacterId character,
                                       Action action,
                                       const ThrowWish& wish) const {
  if (const Status good = check_hand(character, wish.action.clip, wish.side); !good) {
    return good.error();
  }
  const CharacterPlayer& who = player(character);
  action.id = ActionId{next_action_};
  return ThrowPlayer::make(*base_, action, wish, who.character().skeleton, who.map());
}

Result<ActionId> Engine::play(CharacterId character, const ThrowWish& wish) {
  auto action = checked(character, wish.action);
  if (!action) return action.error();
  auto made = made_throw(character, *action, wish);
  if (!made) return made.error();
  player(character).play_throw(*std::move(made));
  return add_action(character, *std::move(action));
}

Status Engine::aim_ball(CharacterId character, int side, const glm::dvec3& p_in_world) {
  if (const auto known = check_character(character); !known) return known.error();
  if (side == 0 || side == 1) {
    if (ThrowPlayer* made = player(character).throwing(side)) {
      return made->aim(p_in_world);
    }
  }
  return bad_input("character " + std::to_string(static_cast<int>(character)),
                   "this hand does not throw",
                   "play a throw with it first");
}

Result<ThrowFeasibility> Engine::ask(CharacterId character, const ThrowWish& wish) const {
  auto action = checked(character, wish.action);
  if (!action) return action.error();
  auto made = made_throw(character, *action, wish);
  if (!made) return made.error();
  return made->ask(player(character).blend().root(), *action, step_s());
}

Result<ReachPlayer> Engine::made_reach(CharacterId character,
                                       const Action& action,
                                       const ReachWish& wish) const {
  if (const Status good = check_hand(character, wish.action.clip, wish.side); !good) {
    return good.error();
  }
  const CharacterPlayer& who = player(character);
  return ReachPlayer::make(*base_,
                           ActionId{next_action_},
                           action.clip,
                           wish,
                           who.character().skeleton,
                           who.map());
}

Status Engine::aim(CharacterId character, int side, const ReachTarget& target) {
  if (const auto known = check_character(character); !known) return known.error();
  if (side == 0 || side == 1) {
    if (ReachPlayer* reach = player(character).reaching(side)) return reach->aim(target);
  }
  return bad_input("character " + std::to_string(static_cast<int>(character)),
                   "this hand does not reach",
                   "play a reach with it first");
}

Result<ReachFeasibility> Engine::ask(CharacterId character, const ReachWish& wish) const {
  auto action = checked(character, wish.action);
  if (!action) return action.error();
  if (!wish.family.empty()) {
    const auto chosen = chosen_family(character, wish);
    if (!chosen) return chosen.error();
    action->clip = chosen->front().clip;
    action->rate *= chosen->front().rate;
  }
  auto reach = made_reach(character, *action, wish);
  if (!reach) return reach.error();
  ReachFeasibility answer = reach->ask(player(character).blend(), *action);
  answer.steps = steps_in(answer.duration_s, step_s());
  return answer;
}

Result<SteerAnswer> Engine::ask(CharacterId character, const SteerWish& wish) const {
  auto action = checked(character, wish.action);
  if (!action) return action.error();
  const MotionClip& clip = base_->clip(action->clip);
  const std::shared_ptr<const ClipTravel>& travel = travels_[action->clip];
  if (!travel) return travel_of_clip(clip).error();
  const BlendPlayer& blend = player(character).blend();
  SteerQuestion question;
  question.root = blend.root();
  question.clip_s = action->entry_s.value_or(0.0);
  // A walk that plays goes on from where it is.
  if (const Action* lead = blend.lead(); lead != nullptr && lead->clip == action->clip) {
    question.clip_s = lead->warp.source_s(time_s());
  }
  question.rate = action->rate;
  question.leg_length_m = blend.rig().leg_length_m;
  question.goal_xz_m = wish.goal_xz_m;
  return ask_steer(clip, *travel, question, wish.settings);
}

Result<ActionId> Engine::play(CharacterId character, const FollowWish& wish) {
  if (const auto known = check_character(character); !known) return known.error();
  auto made = player(character).make_follow(ActionId{next_action_}, wish);
  if (!made) return made.error();
  player(character).follow(*std::move(made));
  return ActionId{next_action_++};
}

Status Engine::aim(CharacterId character,
                   ActionId follow,
                   const glm::dvec3& target_in_world) {
  if (const auto known = check_character(character); !known) return known.error();
  if (FollowPlayer* found = player(character).following(follow)) {
    return found->aim(target_in_world);
  }
  return bad_input("action " + std::to_string(number(follow)),
                   "no point follows by this action",
                   "use an id that play() returned for a FollowWish");
}

Result<FollowFeasibility> Engine::ask(CharacterId character,
                                      const FollowWish& wish) const {
  if (const auto known = check_character(character); !known) return known.error();
  return player(character).ask_follow(wish, step_s());
}

}  // namespace marey::engine
