// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "app/stage/live/live_figures.h"
#include "app/stage/live/stage_request.h"
#include "app/stage/live/stage_targets.h"
#include "app/stage/live/step_clock.h"
#include "app/stage/run/scene_run.h"
#include "core/base/result.h"
#include "core/base/time.h"

namespace marey::app {

/// A scene that runs against a clock: play, pause, restart, targets held by a user. Reads
/// no clock itself. Used by one thread.
///
/// The scene goes on after its duration: targets follow their paths, loops continue.
class StageSession {
 public:
  /// At most this many steps are made at once after a delay. [s]
  static constexpr double kMaxCatchUp_s = 0.1;

  /// Begins to play at `now`. Errors: those of SceneRun::make().
  [[nodiscard]] static Result<StageSession> make(SceneRunInput input, Timestamp now);

  /// Carries out a request of a page. Errors: those of StageTargets::move(); of
  /// SceneRun::make() at a restart.
  [[nodiscard]] Status apply(const StageRequest& request, Timestamp now);

  /// Makes the steps that are due and returns their number; none during a pause.
  int update(Timestamp now);
  /// Returns the time at which the steps of the next frame are due; nullopt: paused.
  [[nodiscard]] std::optional<Timestamp> next_frame() const;
  /// Returns the rate at which frames are sent: that of the steps, or of every n-th one,
  /// so that it is at most 60. [Hz]
  [[nodiscard]] double frames_hz() const;

  [[nodiscard]] const SceneRun& run() const { return run_; }
  [[nodiscard]] bool is_playing() const { return is_playing_; }
  [[nodiscard]] std::span<const StageHandle> handles() const {
    return targets_.handles();
  }
  /// Returns the places of the targets, in the order of the handles.
  [[nodiscard]] std::vector<live::PageTarget> targets() const {
    return targets_.places(run_);
  }
  /// Returns the figures since the last report; see LiveFigures.
  [[nodiscard]] std::vector<live::PageRunFigure> report_figures() {
    return figures_.report(run_);
  }
  /// Returns the number of steps that were skipped because the machine was too slow.
  [[nodiscard]] std::int64_t skipped() const { return clock_.skipped(); }

 private:
  StageSession(SceneRunInput input, SceneRun run, Timestamp now);
  [[nodiscard]] int steps_a_frame() const;
  [[nodiscard]] Status carry_out(live::RunAction action, Timestamp now);

  SceneRunInput input_;
  SceneRun run_;
  StageTargets targets_;
  LiveFigures figures_;
  StepClock clock_;
  bool is_playing_ = true;
};

}  // namespace marey::app
