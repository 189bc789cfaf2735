// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/page/page_run.h"

#include "live/page/page_json.h"

namespace marey::live {
namespace {

const char* name(PageRunState state) {
  return state == PageRunState::kPlaying ? "playing" : "paused";
}

PageJson figure_object(const PageRunFigure& figure) {
  return {{"name", figure.name},
          {"unit", figure.unit},
          {"value", or_null(figure.value)},
          {"bound", figure.bound},
          {"passed", or_null(figure.passed)}};
}

}  // namespace

std::string run_json(const PageRun& run) {
  return in_one_line({{"type", "run"},
                      {"state", name(run.state)},
                      {"time_s", run.time_s},
                      {"duration_s", run.duration_s},
                      {"figures", array_of(run.figures, figure_object)},
                      {"messages", run.messages}});
}

std::string targets_json(std::span<const PageTarget> targets) {
  return in_one_line(
      {{"type", "targets"},
       {"p_in_world",
        array_of(targets, [](const PageTarget& one) { return to_json(one.p_in_world); })},
       {"held",
        array_of(targets, [](const PageTarget& one) { return PageJson(one.held); })}});
}

}  // namespace marey::live
