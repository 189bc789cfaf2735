// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/live/stage_session.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace marey::app {
namespace {

int most_steps_at_once(double step_hz) {
  return std::max(1,
                  static_cast<int>(std::lround(StageSession::kMaxCatchUp_s * step_hz)));
}

}  // namespace

Result<StageSession> StageSession::make(SceneRunInput input, Timestamp now) {
  // For the figures; LiveFigures empties the record again.
  input.records = true;
  auto run = SceneRun::make(input);
  if (!run) return run.error();
  return StageSession(std::move(input), *std::move(run), now);
}

StageSession::StageSession(SceneRunInput input, SceneRun run, Timestamp now)
    : input_(std::move(input)),
      run_(std::move(run)),
      targets_(run_),
      clock_(run_.scene().step_hz, most_steps_at_once(run_.scene().step_hz)) {
  run_.forget_steps();
  clock_.start(now);
}

Status StageSession::carry_out(live::RunAction action, Timestamp now) {
  if (action == live::RunAction::kPause) {
    is_playing_ = false;
    return Done{};
  }
  if (action == live::RunAction::kRestart) {
    auto run = SceneRun::make(input_);
    if (!run) return run.error();
    run_ = *std::move(run);
    run_.forget_steps();
    targets_.reset();
    figures_.reset();
  } else if (is_playing_) {
    return Done{};
  }
  is_playing_ = true;
  clock_.start(now);
  return Done{};
}

Status StageSession::apply(const StageRequest& request, Timestamp now) {
  if (const auto* action = std::get_if<live::RunAction>(&request)) {
    return carry_out(*action, now);
  }
  if (const auto* move = std::get_if<MoveTarget>(&request)) {
    return targets_.move(move->target, move->p_in_world, run_);
  }
  if (const auto* hold = std::get_if<HoldTarget>(&request)) {
    return targets_.hold(hold->target, run_);
  }
  if (const auto* let_go = std::get_if<ReleaseTarget>(&request)) {
    targets_.release(let_go->target, run_);
  }
  return Done{};
}

int StageSession::update(Timestamp now) {
  if (!is_playing_) return 0;
  const int steps = clock_.take_due(now);
  for (int i = 0; i < steps; ++i) {
    run_.advance();
    figures_.add(run_);
  }
  return steps;
}

int StageSession::steps_a_frame() const {
  constexpr double kMaxFrames_hz = 60.0;
  // 60.001 Hz still counts as 60.
  return static_cast<int>(std::ceil(run_.scene().step_hz / kMaxFrames_hz - 1e-3));
}

double StageSession::frames_hz() const {
  return run_.scene().step_hz / std::max(1, steps_a_frame());
}

std::optional<Timestamp> StageSession::next_frame() const {
  if (!is_playing_) return std::nullopt;
  return clock_.next(std::max(1, steps_a_frame()));
}

}  // namespace marey::app
