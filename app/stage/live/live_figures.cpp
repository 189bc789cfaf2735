// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/live/live_figures.h"

#include <cstdio>
#include <string>

#include "app/stage/figures/measure_figures.h"

namespace marey::app {
namespace {

constexpr double kLongestRecord_s = 1.0;

std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

std::string bound_text(const SceneFigure& figure) {
  std::string text;
  if (figure.min) text = "\u2265 " + number_text(*figure.min);
  if (figure.max) {
    text += (text.empty() ? "" : ", ") + ("\u2264 " + number_text(*figure.max));
  }
  return text;
}

std::optional<bool> is_passed(const SceneFigure& figure, std::optional<double> value) {
  if (!value || (!figure.min && !figure.max)) return std::nullopt;
  return (!figure.min || *value >= *figure.min) && (!figure.max || *value <= *figure.max);
}

}  // namespace

void LiveFigures::add(SceneRun& run) {
  const double recorded_s = run.time_s() - run.recorded_from_s();
  if (recorded_s > kLongestRecord_s) run.forget_steps();
}

std::vector<live::PageRunFigure> LiveFigures::report(SceneRun& run) {
  const std::vector<MeasuredFigure> figures = measure_figures(run.record());
  run.forget_steps();
  reported_.resize(figures.size());
  std::vector<live::PageRunFigure> out;
  for (std::size_t f = 0; f < figures.size(); ++f) {
    const SceneFigure& figure = figures[f].figure;
    const SceneFigureRule& rule = rule_of(figure.kind);
    if (figures[f].worst && figures[f].worst->count > 0) {
      reported_[f] = figures[f].worst->value;
    }
    live::PageRunFigure& shown = out.emplace_back();
    shown.name = rule.word;
    if (!figure.point.segment.empty()) shown.name += " " + figure.point.segment;
    shown.unit = rule.unit;
    shown.value = reported_[f];
    shown.bound = bound_text(figure);
    shown.passed = is_passed(figure, reported_[f]);
  }
  return out;
}

}  // namespace marey::app
