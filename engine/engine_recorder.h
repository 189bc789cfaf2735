// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/engine.h"
#include "engine/record/request_fields.h"

#include "core/base/result.h"
#include "core/engine/engine_log.h"

namespace marey::engine {

/// Passes requests to an engine, and keeps the accepted ones, so that the run can be
/// repeated to the byte. Requests that go to the engine directly, changes of its
/// CharacterPlayers and of constraints are not recorded. Recording allocates.
class EngineRecorder {
 public:
  /// `engine` must outlive it. Precondition: its characters are added; no step was done,
  /// nothing was requested.
  explicit EngineRecorder(Engine& engine);

  [[nodiscard]] Engine& engine() { return *engine_; }

  // As the functions of Engine.
  [[nodiscard]] Result<ActionId> play(CharacterId character, const ActionWish& wish);
  [[nodiscard]] Result<ActionId> play(CharacterId character, const SteerWish& wish);
  [[nodiscard]] Result<ActionId> play(CharacterId character, const ReachWish& wish);
  [[nodiscard]] Result<ActionId> play(CharacterId character, const ThrowWish& wish);
  [[nodiscard]] Result<ActionId> play(CharacterId character, const LiveWish& wish);
  [[nodiscard]] Status push(CharacterId character, const LivePosture& posture);
  [[nodiscard]] Status aim(CharacterId character, glm::dvec2 goal_xz_m);
  [[nodiscard]] Status aim(CharacterId character, int side, const ReachTarget& target);
  [[nodiscard]] Status aim_ball(CharacterId character,
                                int side,
                                const glm::dvec3& p_in_world);
  [[nodiscard]] Status stop(CharacterId character, ActionId action);
  [[nodiscard]] Status stop_all(CharacterId character, std::optional<int> layer = {});
  /// CharacterPlayer::set_level(). Error: no such character.
  [[nodiscard]] Status set_level(CharacterId character, DetailLevel level);

  /// The log of all requests up to now.
  [[nodiscard]] EngineLog log() const;

 private:
  template <class Wish>
  Result<ActionId> record(CharacterId character, const char* kind, const Wish& wish);
  void keep(CharacterId character, EngineRequest request);
  Engine* engine_;
  EngineLog log_;
};

/// Repeats a recorded run on another engine, step by step.
///
///     auto replay = EngineReplay::make(log, engine);
///     while (!replay->is_over()) replay->step();
class EngineReplay {
 public:
  /// `log` and `engine` must outlive it. Errors (bad input): the engine has another rate,
  /// other characters or clips than the log, or has done steps; requests that do not
  /// ascend by step, or name a step or character outside of the run.
  [[nodiscard]] static Result<EngineReplay> make(const EngineLog& log, Engine& engine);

  [[nodiscard]] bool is_over() const;
  /// Makes the requests of the next step, and advances. Errors (bad input, with the
  /// request): a kind that is unknown, values that it cannot have, or a refusal by the
  /// engine. Precondition: !is_over().
  [[nodiscard]] Status step();

 private:
  /// Numbers of the actions of the recorded run, and of this one.
  struct Known {
    ActionId recorded{};
    ActionId here{};
  };
  EngineReplay(const EngineLog& log, Engine& engine) : log_(&log), engine_(&engine) {}
  [[nodiscard]] ActionId here(ActionId recorded) const;
  [[nodiscard]] Status request(const EngineRequest& request);
  [[nodiscard]] Status play(const EngineRequest& request);
  [[nodiscard]] Status change(const EngineRequest& request);
  template <class Wish>
  [[nodiscard]] Status play_as(const EngineRequest& request);
  const EngineLog* log_;
  Engine* engine_;
  std::size_t next_ = 0;
  std::vector<Known> known_;
};

}  // namespace marey::engine
