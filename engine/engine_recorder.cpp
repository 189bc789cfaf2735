// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/engine_recorder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/base/assert.h"

namespace marey::engine {
namespace {

std::vector<std::string> names_of_clips(const MotionBase& base) {
  std::vector<std::string> names;
  for (const MotionClip& clip : base.clips()) {
    names.push_back(clip.name + ' ' + std::to_string(clip.frames.size()) + ' ' +
                    clip.document_sha256);
  }
  return names;
}

std::vector<std::string> names_of_characters(const Engine& engine) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < engine.size(); ++i) {
    names.push_back(engine.player(CharacterId{static_cast<int>(i)}).character().name);
  }
  return names;
}

EngineRequest empty_request(const char* kind) {
  EngineRequest out;
  out.kind = kind;
  return out;
}

// A whole number of a request; nullopt: no such number at this place.
std::optional<std::int64_t> whole_at(const EngineRequest& request, std::size_t i) {
  if (i >= request.numbers.size()) return std::nullopt;
  const double number = request.numbers[i];
  if (!(std::abs(number) < 9e15) || number != std::floor(number)) return std::nullopt;
  return static_cast<std::int64_t>(number);
}

Error replay_error(const EngineRequest& request, std::string cause) {
  return bad_input(
      "request \"" + request.kind + "\" of step " + std::to_string(request.step),
      std::move(cause),
      "replay the log with the version of marey that wrote it");
}

Error other_run(std::string cause) {
  return bad_input("replay",
                   std::move(cause),
                   "replay with the characters, the clips and the rate of the log");
}

// An action's number comes before the fields of its wish.
EngineRequest without_first(const EngineRequest& request) {
  EngineRequest out = request;
  if (!out.numbers.empty()) out.numbers.erase(out.numbers.begin());
  return out;
}

ActionWish& wish_of(ActionWish& wish) {
  return wish;
}
template <class Wish>
ActionWish& wish_of(Wish& wish) {
  return wish.action;
}

}  // namespace

EngineRecorder::EngineRecorder(Engine& engine) : engine_(&engine) {
  MAREY_ASSERT(engine.steps() == 0);
  log_.step_hz = engine.step_hz();
  log_.characters = names_of_characters(engine);
  log_.clips = names_of_clips(engine.base());
}

EngineLog EngineRecorder::log() const {
  EngineLog out = log_;
  out.steps = engine_->steps();
  return out;
}

void EngineRecorder::keep(CharacterId character, EngineRequest request) {
  request.step = engine_->steps_before(character);
  request.character = static_cast<int>(character);
  // Within a step, requests to stepped and other characters may alternate.
  auto at = log_.requests.end();
  while (at != log_.requests.begin() && std::prev(at)->step > request.step) --at;
  log_.requests.insert(at, std::move(request));
}

template <class Wish>
Result<ActionId> EngineRecorder::record(CharacterId character,
                                        const char* kind,
                                        const Wish& wish) {
  auto id = engine_->play(character, wish);
  if (!id) return id;
  EngineRequest request = empty_request(kind);
  request.numbers.push_back(static_cast<double>(number(*id)));
  write_fields(wish, request);
  keep(character, std::move(request));
  return id;
}

Result<ActionId> EngineRecorder::play(CharacterId character, const ActionWish& wish) {
  return record(character, "play", wish);
}
Result<ActionId> EngineRecorder::play(CharacterId character, const SteerWish& wish) {
  return record(character, "steer", wish);
}
Result<ActionId> EngineRecorder::play(CharacterId character, const ReachWish& wish) {
  if (!wish.family.empty()) {
    return bad_input("action \"" + wish.action.clip + "\"",
                     "a family of reaches cannot be recorded",
                     "play it with one clip, or without a recorder");
  }
  return record(character, "reach", wish);
}
Result<ActionId> EngineRecorder::play(CharacterId character, const ThrowWish& wish) {
  return record(character, "throw", wish);
}
Result<ActionId> EngineRecorder::play(CharacterId character, const LiveWish& wish) {
  return record(character, "live", wish);
}

Status EngineRecorder::push(CharacterId character, const LivePosture& posture) {
  if (const Status done = engine_->push(character, posture); !done) return done;
  EngineRequest request = empty_request("push");
  write_fields(posture, request);
  keep(character, std::move(request));
  return Done{};
}

Status EngineRecorder::aim(CharacterId character, glm::dvec2 goal_xz_m) {
  if (const Status done = engine_->aim(character, goal_xz_m); !done) return done;
  EngineRequest request = empty_request("aim");
  request.numbers = {goal_xz_m.x, goal_xz_m.y};
  keep(character, std::move(request));
  return Done{};
}

Status EngineRecorder::aim(CharacterId character, int side, const ReachTarget& target) {
  if (const Status done = engine_->aim(character, side, target); !done) return done;
  EngineRequest request = empty_request("aim hand");
  request.numbers = {static_cast<double>(side)};
  write_fields(target, request);
  keep(character, std::move(request));
  return Done{};
}

Status EngineRecorder::aim_ball(CharacterId character,
                                int side,
                                const glm::dvec3& p_in_world) {
  if (const Status done = engine_->aim_ball(character, side, p_in_world); !done) {
    return done;
  }
  EngineRequest request = empty_request("aim ball");
  request.numbers = {static_cast<double>(side), p_in_world.x, p_in_world.y, p_in_world.z};
  keep(character, std::move(request));
  return Done{};
}

Status EngineRecorder::stop(CharacterId character, ActionId action) {
  if (const Status done = engine_->stop(character, action); !done) return done;
  EngineRequest request = empty_request("stop");
  request.numbers = {static_cast<double>(number(action))};
  keep(character, std::move(request));
  return Done{};
}

Status EngineRecorder::stop_all(CharacterId character, std::optional<int> layer) {
  if (const Status done = engine_->stop_all(character, layer); !done) return done;
  EngineRequest request = empty_request("stop all");
  if (layer) request.numbers = {static_cast<double>(*layer)};
  keep(character, std::move(request));
  return Done{};
}

Status EngineRecorder::set_level(CharacterId character, DetailLevel level) {
  const auto i = static_cast<std::size_t>(character);
  if (static_cast<int>(character) < 0 || i >= engine_->size()) {
    return bad_input("level of detail", "there is no such character", "add it first");
  }
  engine_->player(character).set_level(level);
  EngineRequest request = empty_request("level");
  request.numbers = {static_cast<double>(level)};
  keep(character, std::move(request));
  return Done{};
}

Result<EngineReplay> EngineReplay::make(const EngineLog& log, Engine& engine) {
  if (engine.steps() != 0) return other_run("the engine has done steps already");
  if (log.step_hz != engine.step_hz()) return other_run("the engine has another rate");
  if (log.characters != names_of_characters(engine)) {
    return other_run("the engine has other characters");
  }
  if (log.clips != names_of_clips(engine.base())) {
    return other_run("the motion base has other clips");
  }
  std::int64_t last = 0;
  for (const EngineRequest& request : log.requests) {
    const bool is_in_order = request.step >= last && request.step <= log.steps;
    if (!is_in_order) return replay_error(request, "its step is out of order");
    if (request.character < 0 ||
        static_cast<std::size_t>(request.character) >= engine.size()) {
      return replay_error(request, "it is for an unknown character");
    }
    last = request.step;
  }
  return EngineReplay(log, engine);
}

bool EngineReplay::is_over() const {
  return engine_->steps() >= log_->steps;
}

ActionId EngineReplay::here(ActionId recorded) const {
  for (const Known& known : known_) {
    if (known.recorded == recorded) return known.here;
  }
  // No action has this number.
  return ActionId{std::numeric_limits<std::int64_t>::max()};
}

template <class Wish>
Status EngineReplay::play_as(const EngineRequest& request) {
  const auto recorded = whole_at(request, 0);
  auto wish = read_fields<Wish>(without_first(request));
  if (!recorded || !wish) return replay_error(request, "it has other values");
  ActionStart& start = wish_of(*wish).start;
  if (start.action != ActionId{}) start.action = here(start.action);
  const auto id = engine_->play(CharacterId{request.character}, *wish);
  if (!id) return id.error();
  known_.push_back({ActionId{*recorded}, *id});
  return Done{};
}

Status EngineReplay::play(const EngineRequest& request) {
  if (request.kind == "play") return play_as<ActionWish>(request);
  if (request.kind == "steer") return play_as<SteerWish>(request);
  if (request.kind == "reach") return play_as<ReachWish>(request);
  if (request.kind == "throw") return play_as<ThrowWish>(request);
  if (request.kind == "live") return play_as<LiveWish>(request);
  return replay_error(request, "its kind is unknown");
}

Status EngineReplay::change(const EngineRequest& request) {
  const CharacterId who{request.character};
  const std::vector<double>& n = request.numbers;
  const auto first = whole_at(request, 0);
  if (request.kind == "aim" && n.size() == 2) return engine_->aim(who, {n[0], n[1]});
  if (request.kind == "aim ball" && n.size() == 4 && first) {
    return engine_->aim_ball(who, static_cast<int>(*first), {n[1], n[2], n[3]});
  }
  if (request.kind == "aim hand" && first) {
    const auto target = read_fields<ReachTarget>(without_first(request));
    if (target) return engine_->aim(who, static_cast<int>(*first), *target);
  }
  if (request.kind == "stop" && n.size() == 1 && first) {
    return engine_->stop(who, here(ActionId{*first}));
  }
  if (request.kind == "stop all" && n.empty()) return engine_->stop_all(who);
  if (request.kind == "stop all" && n.size() == 1 && first) {
    return engine_->stop_all(who, static_cast<int>(*first));
  }
  if (request.kind == "level" && n.size() == 1 && first && *first >= 0 &&
      *first <= static_cast<int>(DetailLevel::kKinetic)) {
    engine_->player(who).set_level(static_cast<DetailLevel>(*first));
    return Done{};
  }
  return replay_error(request, "it has other values");
}

Status EngineReplay::request(const EngineRequest& request) {
  if (request.kind == "push") {
    const auto posture = read_fields<LivePosture>(request);
    if (!posture) return replay_error(request, "it has other values");
    return engine_->push(CharacterId{request.character}, *posture);
  }
  for (const char* kind : {"aim", "aim hand", "aim ball", "stop", "stop all", "level"}) {
    if (request.kind == kind) return change(request);
  }
  return play(request);
}

Status EngineReplay::step() {
  MAREY_ASSERT(!is_over());
  while (next_ < log_->requests.size() &&
         log_->requests[next_].step <= engine_->steps()) {
    if (const Status done = request(log_->requests[next_]); !done) return done;
    ++next_;
  }
  engine_->advance();
  return Done{};
}

}  // namespace marey::engine
