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
    : base_(std::move(base)), options_(options) {
  for (const MotionClip& clip : base_->clips()) {
    std::shared_ptr<const ClipTravel> travel;
    if (auto found = travel_of_clip(clip)) {
      travel = std::make_shared<const ClipTravel>(*std::move(found));
    }
    travels_.push_back(std::move(travel));
  }
}

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
  auto action =
      check_wish(wish, who.blend().base(), who.blend().actions(), groups_of(who.map()));
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
  auto action = check_live_wish(
      wish.action, who.blend().base(), who.blend().actions(), groups_of(who.map()));
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

Status Engine::stop(CharacterId character, ActionId action) {
  if (const auto known = check_character(character); !known) return known.error();
  if (player(character).blend().stop(action)) return Done{};
  if (FollowPlayer* follow = player(character).following(action)) {
    follow->stop();
    return Done{};
  }
  return bad_input("action " + std::to_string(number(action)),
                   "it is over, or was never requested",
                   "use an id that play() returned");
}

Status Engine::stop_all(CharacterId character, std::optional<int> layer) {
  if (const auto known = check_character(character); !known) return known.error();
  player(character).blend().stop_layer(layer);
  if (!layer) {
    for (FollowPlayer& follow : player(character).follows()) follow.stop();
  }
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
  return *characters_[static_cast<std::size_t>(character)];
}

ActionPhase Engine::phase(CharacterId character, ActionId action) const {
  if (const FollowPlayer* follow = player(character).following(action)) {
    return follow->is_stopping() ? ActionPhase::kFadingOut : ActionPhase::kHolding;
  }
  const Action* found = player(character).blend().find(action);
  return found == nullptr ? ActionPhase::kDone : found->phase;
}

}  // namespace marey::engine
