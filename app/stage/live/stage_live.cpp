// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/live/stage_live.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>
#include <utility>

#include "app/shell/stop_signal.h"
#include "app/view/view_commands.h"

namespace marey::app {
namespace {

using namespace std::chrono_literals;

/// Time between two looks at requests during a pause.
constexpr Timestamp kFrame = Timestamp(1'000'000'000 / 60);
/// Time between two messages about state and figures.
constexpr Timestamp kReport = 250ms;
/// A step that is due within this time is made with the present ones, because a sleep
/// takes longer. [ns]
constexpr Timestamp kSlack = 100us;

void print_loop_figures(const StageLoopFigures& figures,
                        const StageSession& session,
                        Console& console) {
  char text[160];
  std::snprintf(text,
                sizeof text,
                "%ld steps, %.3f ms each (mean); %ld frames sent",
                figures.steps,
                figures.steps > 0
                    ? 1000.0 * figures.busy_s / static_cast<double>(figures.steps)
                    : 0.0,
                figures.frames);
  console.say(text);
  if (session.skipped() > 0) {
    console.warn(std::to_string(session.skipped()) +
                 " steps were skipped, because this machine is too slow");
  }
}

}  // namespace

void add_stage_live_options(CLI::App& command, StageLiveOptions& options) {
  command
      .add_option("--vmc",
                  options.vmc,
                  "Receiver of VMC with --live: [BODY=]HOST[:PORT]; may be repeated")
      ->allow_extra_args(false);
  add_page_options(command, options.page);
}

StageLoopClock steady_loop_clock() {
  using Steady = std::chrono::steady_clock;
  StageLoopClock clock;
  clock.now = [] {
    return std::chrono::duration_cast<Timestamp>(Steady::now().time_since_epoch());
  };
  clock.sleep_until = [](Timestamp until) {
    std::this_thread::sleep_until(
        Steady::time_point(std::chrono::duration_cast<Steady::duration>(until)));
  };
  return clock;
}

StageLoopFigures run_stage_loop(const StageLoopParts& parts,
                                const StageLoopOptions& options,
                                const StageLoopClock& clock) {
  auto& [session, vmc, page] = parts;
  StageLoopFigures figures;
  const Timestamp begin = clock.now();
  Timestamp report_due = begin;
  for (Timestamp now = begin;; now = clock.now()) {
    if (options.is_stopped && options.is_stopped()) break;
    if (options.seconds && seconds(now - begin) >= *options.seconds) break;
    if (page != nullptr) page->answer(session, now);
    const int steps = session.update(now + kSlack);
    if (steps > 0) {
      const double busy_s = seconds(clock.now() - now);
      figures.busy_s += busy_s;
      figures.steps += steps;
      ++figures.frames;
      vmc.send(now - begin, session.run());
      if (page != nullptr) page->publish_frame(session, now);
    }
    if (page != nullptr && now >= report_due) {
      page->publish_run(session);
      report_due = now + kReport;
    }
    // A scene of few steps a second still answers its pages.
    clock.sleep_until(
        std::min(session.next_frame().value_or(now + kFrame), now + 2 * kFrame));
  }
  return figures;
}

Exit run_stage_live(SceneRunInput input,
                    const StageLiveOptions& options,
                    Console& console) {
  const StageLoopClock clock = steady_loop_clock();
  auto routes = plan_vmc(input.scene, options.vmc);
  if (!routes) return console.fail(routes.error());
  auto session = StageSession::make(std::move(input), clock.now());
  if (!session) return console.fail(session.error());
  auto vmc = StageVmc::open(*routes, session->run());
  if (!vmc) return console.fail(vmc.error());
  auto page = StagePage::open(options.page, *session);
  if (!page) return console.fail(page.error());
  catch_stop_signals();
  print_addresses(page->server(), options.page);
  for (const VmcRoute& route : *routes) {
    console.say("sends " + session->run().body(route.body).id + " by VMC to " +
                live::text_of(route.address));
  }
  if (!options.seconds) console.say("open the address in a browser; Ctrl-C ends it");
  // The start of the server took time.
  if (const Status ok = session->apply(live::RunAction::kRestart, clock.now()); !ok) {
    return console.fail(ok.error());
  }
  const StageLoopFigures figures =
      run_stage_loop({*session, *vmc, &*page}, {options.seconds, stop_wanted}, clock);
  print_loop_figures(figures, *session, console);
  return Exit::kOk;
}

}  // namespace marey::app
