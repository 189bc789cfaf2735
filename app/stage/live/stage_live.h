// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/shell/console.h"
#include "app/shell/exit_codes.h"
#include "app/stage/live/stage_page.h"
#include "app/stage/live/stage_session.h"
#include "app/stage/live/stage_vmc.h"
#include "app/stage/run/scene_run.h"
#include "app/view/page_server.h"
#include "core/base/time.h"

namespace marey::app {

/// Options of `marey stage --live`.
struct StageLiveOptions {
  PageServerOptions page{};
  std::vector<std::string> vmc{};   ///< [BODY=]HOST[:PORT], see plan_vmc().
  std::optional<double> seconds{};  ///< Stops after this time. [s]
};

/// Adds --vmc and the options of the page to the command.
void add_stage_live_options(CLI::App& command, StageLiveOptions& options);

/// Clock of the loop; tests simulate it.
struct StageLoopClock {
  std::function<Timestamp()> now;
  std::function<void(Timestamp)> sleep_until;
};
[[nodiscard]] StageLoopClock steady_loop_clock();

struct StageLoopOptions {
  std::optional<double> seconds{};
  std::function<bool()> is_stopped{};
};

/// Parts of a live run. `page` may be null.
struct StageLoopParts {
  StageSession& session;
  StageVmc& vmc;
  StagePage* page = nullptr;
};

/// Figures of a live run.
struct StageLoopFigures {
  long steps = 0;
  long frames = 0;      ///< Sent to pages and by VMC.
  double busy_s = 0.0;  ///< Time of the steps, by the clock.
};

/// Steps the scene at its rate until it is stopped, and sends a frame after the steps
/// that were due, at most 60 a second. During a pause it answers pages only.
[[nodiscard]] StageLoopFigures run_stage_loop(const StageLoopParts& parts,
                                              const StageLoopOptions& options,
                                              const StageLoopClock& clock);

/// Runs a scene live until Ctrl-C: `marey stage --live`. Exit codes as `marey live`.
[[nodiscard]] Exit run_stage_live(SceneRunInput input,
                                  const StageLiveOptions& options,
                                  Console& console);

}  // namespace marey::app
