// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/engine.h"

#include <cmath>
#include <string>
#include <utility>

#include "engine/actions/check_wish.h"

#include "core/base/assert.h"
#include "core/base/parallel.h"

namespace marey::engine {
namespace {

std::array<bool, kGroupCount> groups_of(const retarget::BodyMap& map) {
  std::array<bool, kGroupCount> out{};
  out.fill(true);
  const auto has = [&](HumanBone bone) { return map.joint_of[index(bone)].has_value(); };
  out[static_cast<std::size_t>(EditGroup::kTrunk)] =
      map.abdomen.count > 0 || map.torso.count > 0;
  out[static_cast<std::size_t>(EditGroup::kHead)] =
      has(HumanBone::kHead) || has(HumanBone::kNeck);
  return out;
}

// Live postures may be ahead of the engine by so much.
constexpr double kMaxAhead_s = 0.1;

Error no_room(const std::string& clip) {
  return bad_input(
      "action \"" + clip + "\"",
      "the character has " + std::to_string(kMaxActions) + " actions already",
      "stop some of them first");
}

}  // namespace

Engine::Engine(std::shared_ptr<const MotionBase> base, const EngineOptions& options)
    : base_(std::move(base)), options_(options) {}

Result<Engine> Engine::make(std::shared_ptr<const MotionBase> base,
                            const EngineOptions& options) {
  if (base == nullptr) {
    return bad_input("engine", "there is no motion base", "read one with read_moves()");
  }
  if (!(options.step_hz >= 1.0 && options.step_hz <= 1000.0)) {
    return bad_input(
        "engine", "the rate is not in [1, 1000] Hz", "give 60 Hz, for example");
  }
  if (options.threads < 1) {
    return bad_input("engine", "less than one thread", "give one thread or more");
  }
  return Engine(std::move(base), options);
}

Result<CharacterId> Engine::add(CharacterSpec spec) {
  MAREY_ASSERT(!is_stepping_);
  const std::string where = "character \"" + spec.character.name + "\"";
  if (!std::isfinite(spec.start.x_m + spec.start.z_m + spec.start.heading_rad)) {
    return bad_input(where, "its start is not finite", "give a place on the floor");
  }
  if (!std::isfinite(spec.importance) || spec.importance < 0.0) {
    return bad_input(where, "its importance is negative or not finite", "give 0 or more");
  }
  auto player = CharacterPlayer::make(base_, std::move(spec));
  if (!player) return player.error();
  characters_.push_back(*std::move(player));
  stepped_.push_back(steps_);
  return CharacterId{static_cast<int>(characters_.size()) - 1};
}

Status Engine::check_character(CharacterId character) const {
  const int i = static_cast<int>(character);
  if (i >= 0 && static_cast<std::size_t>(i) < characters_.size()) return Done{};
  return bad_input("character " + std::to_string(i),
                   "the engine has no such character",
                   "use an id that add() returned");
}

Result<Action> Engine::checked(CharacterId character, const ActionWish& wish) const {
  if (const auto known = check_character(character); !known) return known.error();
  const CharacterPlayer& who = player(character);
  auto action = check_wish(wish, *base_, who.blend().actions(), groups_of(who.map()));
  if (!action) return action.error();
  if (!who.blend().has_room()) return no_room(wish.clip);
  return action;
}

ActionId Engine::add_action(CharacterId character, Action action) {
  action.id = ActionId{next_action_++};
  player(character).blend().add(action);
  return action.id;
}

Result<ActionId> Engine::play(CharacterId character, const ActionWish& wish) {
  auto action = checked(character, wish);
  if (!action) return action.error();
  return add_action(character, *std::move(action));
}

Result<ActionId> Engine::play(CharacterId character, const LiveWish& wish) {
  if (const auto known = check_character(character); !known) return known.error();
  if (const Status good = check_live_options(wish.options); !good) return good.error();
  CharacterPlayer& who = player(character);
  auto action =
      check_live_wish(wish.action, *base_, who.blend().actions(), groups_of(who.map()));
  if (!action) return action.error();
  if (!who.blend().has_room()) return no_room(wish.action.clip);
  action->id = ActionId{next_action_++};
  who.blend().add_live(*action, wish.options);
  return action->id;
}

Status Engine::push(CharacterId character, const LivePosture& posture) {
  if (const auto known = check_character(character); !known) return known.error();
  LivePlayer* live = player(character).blend().live();
  if (live == nullptr) {
    return bad_input("character " + std::to_string(static_cast<int>(character)),
                     "it has no live source",
                     "play one with a LiveWish first");
  }
  if (posture.time_s > time_s() + step_s() + kMaxAhead_s) {
    return bad_input("live posture",
                     "its time is later than the next step by more than 0.1 s",
                     "give times on the engine's clock");
  }
  return live->push(posture);
}

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
  auto reach = made_reach(character, *action, wish);
  if (!reach) return reach.error();
  player(character).reach(*std::move(reach));
  return add_action(character, *std::move(action));
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
  auto reach = made_reach(character, *action, wish);
  if (!reach) return reach.error();
  return reach->ask(player(character).blend(), *action);
}

Status Engine::stop(CharacterId character, ActionId action) {
  if (const auto known = check_character(character); !known) return known.error();
  if (player(character).blend().stop(action)) return Done{};
  return bad_input("action " + std::to_string(number(action)),
                   "it is over, or was never requested",
                   "use an id that play() returned");
}

Status Engine::stop_all(CharacterId character, std::optional<int> layer) {
  if (const auto known = check_character(character); !known) return known.error();
  player(character).blend().stop_layer(layer);
  return Done{};
}

void Engine::advance(int steps) {
  MAREY_ASSERT(steps >= 0 && !is_stepping_);
  for (int i = 0; i < steps; ++i) {
    begin_step();
    if (options_.threads > 1) {
      in_parallel(characters_.size(),
                  static_cast<std::size_t>(options_.threads),
                  [&](std::size_t c) { step(CharacterId{static_cast<int>(c)}); });
    }
    end_step();
  }
}

void Engine::begin_step() {
  MAREY_ASSERT(!is_stepping_);
  is_stepping_ = true;
  ++steps_;
}

void Engine::step(CharacterId character) {
  MAREY_ASSERT(is_stepping_);
  CharacterPlayer& who = player(character);
  std::int64_t& last = stepped_[static_cast<std::size_t>(character)];
  MAREY_ASSERT(last < steps_);
  last = steps_;
  who.step(time_s(), step_s());
}

void Engine::end_step() {
  MAREY_ASSERT(is_stepping_);
  for (std::size_t c = 0; c < characters_.size(); ++c) {
    if (stepped_[c] < steps_) step(CharacterId{static_cast<int>(c)});
  }
  is_stepping_ = false;
}

double Engine::time_s() const {
  return static_cast<double>(steps_) / options_.step_hz;
}

std::int64_t Engine::steps_before(CharacterId character) const {
  MAREY_ASSERT(check_character(character).has_value());
  const bool is_due =
      is_stepping_ && stepped_[static_cast<std::size_t>(character)] < steps_;
  return is_due ? steps_ - 1 : steps_;
}

const Pose& Engine::pose(CharacterId character) const {
  return player(character).pose();
}

CharacterPlayer& Engine::player(CharacterId character) {
  return const_cast<CharacterPlayer&>(std::as_const(*this).player(character));
}

const CharacterPlayer& Engine::player(CharacterId character) const {
  MAREY_ASSERT(check_character(character).has_value());
  return characters_[static_cast<std::size_t>(character)];
}

ActionPhase Engine::phase(CharacterId character, ActionId action) const {
  const Action* found = player(character).blend().find(action);
  return found == nullptr ? ActionPhase::kDone : found->phase;
}

}  // namespace marey::engine
