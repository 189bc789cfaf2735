// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/engine.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "engine/actions/check_wish.h"

#include "core/base/assert.h"
#include "core/base/parallel.h"

namespace marey::engine {
namespace {

/// Number of characters that are prepared and then adapted together.
constexpr std::size_t kBlock = 256;
/// Fewer are not adapted in lanes: most of these would be empty.
constexpr std::size_t kMinLaneJobs = 6;

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
  characters_.push_back(std::make_unique<CharacterPlayer>(*std::move(player)));
  const Status joined = join_crowd(*characters_.back());
  if (!joined) {
    characters_.pop_back();
    return joined.error();
  }
  stepped_.push_back(steps_);
  adapts_.push_back(0);
  return CharacterId{static_cast<int>(characters_.size()) - 1};
}

Status Engine::join_crowd(CharacterPlayer& player) {
  for (std::size_t i = 0; i < crowds_.size(); ++i) {
    if (!crowds_[i]->takes(player.adapter())) continue;
    auto member = crowds_[i]->add(player.leave_adapter());
    if (!member) return member.error();
    player.join(*crowds_[i], *member);
    crowd_of_.push_back(i);
    const std::size_t most = options_.threads > 1 ? *member + 1 : kBlock;
    jobs_[i].reserve(std::min(*member + 1, most));
    return Done{};
  }
  std::vector<retarget::Adapter> first;
  first.push_back(player.leave_adapter());
  retarget::CrowdOptions options;
  options.threads = options_.threads;
  options.min_lane_jobs = kMinLaneJobs;
  auto crowd = retarget::Crowd::make(std::move(first), options);
  if (!crowd) return crowd.error();
  crowds_.push_back(std::make_unique<retarget::Crowd>(*std::move(crowd)));
  player.join(*crowds_.back(), 0);
  crowd_of_.push_back(crowds_.size() - 1);
  jobs_.emplace_back().reserve(1);
  return Done{};
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
  if (!who.blend().has_room()) {
    return bad_input(
        "action \"" + wish.clip + "\"",
        "the character has " + std::to_string(kMaxActions) + " actions already",
        "stop some of them first");
  }
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
  const std::size_t count = characters_.size();
  // With one thread in blocks, whose memory stays in the cache between both parts.
  const std::size_t block = options_.threads > 1 ? count : kBlock;
  for (std::size_t first = 0; first < count; first += block) {
    step_block(first, std::min(first + block, count));
  }
  is_stepping_ = false;
}

void Engine::step_block(std::size_t first, std::size_t end) {
  const double now_s = time_s();
  const auto prepare = [&](std::size_t c) {
    adapts_[c] = 0;
    if (stepped_[c] == steps_) return;
    stepped_[c] = steps_;
    if (characters_[c]->prepare_step(now_s, step_s())) adapts_[c] = 1;
  };
  if (options_.threads > 1) {
    in_parallel(end - first,
                static_cast<std::size_t>(options_.threads),
                [&](std::size_t i) { prepare(first + i); });
  } else {
    for (std::size_t c = first; c < end; ++c) prepare(c);
  }
  for (auto& jobs : jobs_) jobs.clear();
  for (std::size_t c = first; c < end; ++c) {
    if (adapts_[c] != 0) jobs_[crowd_of_[c]].push_back(characters_[c]->adapt_job());
  }
  for (std::size_t i = 0; i < crowds_.size(); ++i) {
    if (!jobs_[i].empty()) crowds_[i]->adapt(jobs_[i], now_s);
  }
  for (std::size_t c = first; c < end; ++c) {
    if (adapts_[c] != 0) characters_[c]->finish_step();
  }
}

double Engine::time_s() const {
  return static_cast<double>(steps_) / options_.step_hz;
}

const Pose& Engine::pose(CharacterId character) const {
  return player(character).pose();
}

CharacterPlayer& Engine::player(CharacterId character) {
  return const_cast<CharacterPlayer&>(std::as_const(*this).player(character));
}

const CharacterPlayer& Engine::player(CharacterId character) const {
  MAREY_ASSERT(check_character(character).has_value());
  return *characters_[static_cast<std::size_t>(character)];
}

ActionPhase Engine::phase(CharacterId character, ActionId action) const {
  const Action* found = player(character).blend().find(action);
  return found == nullptr ? ActionPhase::kDone : found->phase;
}

}  // namespace marey::engine
