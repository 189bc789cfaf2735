// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/figures/measure_figures.h"

#include <algorithm>
#include <utility>

#include "app/stage/figures/body_figures.h"
#include "app/stage/figures/figure_users.h"
#include "app/stage/figures/point_figures.h"
#include "app/stage/figures/recorded_body.h"
#include "app/stage/figures/throw_figures.h"

namespace marey::app {
namespace {

using Measured = std::optional<BodyFigure>;

Measured from_worst(const WorstValue& worst) {
  if (worst.count == 0) return std::nullopt;
  return BodyFigure{{}, worst.value, worst.time_s, worst.count, 0};
}

Measured from_value(std::optional<double> value, const FigureSpan& span) {
  if (!value) return std::nullopt;
  return BodyFigure{{}, *value, span.from_s, 1, 0};
}

/// One figure of one body.
struct FigureTask {
  const StageRecord& record;
  const SceneFigure& figure;
  const FigureUser& user;
  const FigureBody& body;
  FigureSpan span;
};

Measured measure_point(const FigureTask& task) {
  const auto point = find_point(task.body, task.figure.point);
  const std::vector<glm::dvec3> targets =
      recorded_target(task.record, task.figure.target, task.user.body, task.user.member);
  if (!point || targets.size() != task.body.poses.size()) return std::nullopt;
  if (task.figure.kind == SceneFigureKind::kClearance) {
    return from_worst(clearance_mm(task.body, *point, targets, task.span));
  }
  if (task.figure.kind == SceneFigureKind::kWristError) {
    const ReachedError reached = reached_error_mm(task.body, *point, targets, task.span);
    Measured measured = from_worst(reached.error_mm);
    if (measured) measured->beyond = reached.beyond;
    return measured;
  }
  WorstValue worst;
  for (const double time_s : event_times_s(task.record, task.figure, task.user)) {
    if (!task.span.contains(time_s)) continue;
    worst.add(distance_at_mm(task.body, *point, targets, time_s), time_s);
  }
  return from_worst(worst);
}

Measured measure_feet(const FigureTask& task) {
  WorstValue worst;
  for (const auto& foot : foot_steps(task.body, task.span)) {
    const WorstValue one = task.figure.kind == SceneFigureKind::kTwist
                               ? foot_twist_deg(foot)
                               : foot_slide_mm(foot);
    if (one.count > 0) worst.add(one.value, one.time_s);
  }
  return from_worst(worst);
}

Measured measure_arrival(const FigureTask& task) {
  WorstValue worst;
  for (const StageActionRun& run : task.record.actions) {
    if (run.body != task.user.body) continue;
    const SceneAction& action = task.record.scene.script[run.action];
    if (action.id != task.figure.action) continue;
    const std::vector<glm::dvec3> targets =
        recorded_target(task.record, target_of(action), task.user.body, task.user.member);
    if (targets.size() != task.body.poses.size()) return std::nullopt;
    for (const double time_s : arrival_times_s(task.body, run, targets)) {
      if (!task.span.contains(time_s)) continue;
      worst.add(hips_distance_m(task.body, targets, time_s), time_s);
    }
  }
  return from_worst(worst);
}

Measured measure_clip(const FigureTask& task) {
  const PostureLayout& layout = task.record.base->layout();
  const double step_s = 1.0 / task.record.scene.step_hz;
  if (task.figure.kind == SceneFigureKind::kJerkRatio) {
    const auto clips = played_clips(task.record, task.user.body);
    return from_value(jerk_ratio(task.body, clips, layout, task.span, step_s), task.span);
  }
  const auto clip = task.record.base->find(task.figure.clip);
  if (!clip) return std::nullopt;
  return from_value(
      sway_deviation_percent(
          task.body, task.record.base->clip(*clip), layout, task.span, step_s),
      task.span);
}

Measured measure_balance(const FigureTask& task) {
  if (task.body.references.empty()) return std::nullopt;
  return from_worst(task.figure.kind == SceneFigureKind::kComError
                        ? com_error_mm(task.body, task.span)
                        : pelvis_back_mm(task.body, task.span));
}

Measured measure_throws(const FigureTask& task) {
  WorstValue worst;
  for (const StageThrow& thrown : task.record.throws) {
    const SceneAction& action = task.record.scene.script[thrown.action];
    if (thrown.body != task.user.body || action.id != task.figure.action) continue;
    if (!task.span.contains(thrown.release_s)) continue;
    worst.add(throw_figure(task.figure.kind, thrown), thrown.release_s);
  }
  return from_worst(worst);
}

Measured measure_one(const FigureTask& task) {
  switch (task.figure.kind) {
    case SceneFigureKind::kWristError:
    case SceneFigureKind::kParry:
    case SceneFigureKind::kClearance:
      return measure_point(task);
    case SceneFigureKind::kFeetSlide:
    case SceneFigureKind::kTwist:
      return measure_feet(task);
    case SceneFigureKind::kComError:
    case SceneFigureKind::kPelvisBack:
      return measure_balance(task);
    case SceneFigureKind::kArrival:
      return measure_arrival(task);
    case SceneFigureKind::kSwaySpectrum:
    case SceneFigureKind::kJerkRatio:
      return measure_clip(task);
    case SceneFigureKind::kThrowPlace:
    case SceneFigureKind::kThrowDirection:
    case SceneFigureKind::kThrowSpeed:
    case SceneFigureKind::kReleaseTime:
      return measure_throws(task);
    case SceneFigureKind::kStepTime:
      break;
  }
  return std::nullopt;
}

void judge(MeasuredFigure& measured) {
  const SceneFigure& figure = measured.figure;
  const bool least = figure.min && !figure.max;
  bool within = true;
  for (std::size_t i = 0; i < measured.bodies.size(); ++i) {
    const BodyFigure& value = measured.bodies[i];
    within = within && (!figure.min || value.value >= *figure.min) &&
             (!figure.max || value.value <= *figure.max);
    if (i > 0 && value.value <= measured.bodies[i - 1].value) measured.ascends = false;
    if (!measured.worst || (least ? value.value < measured.worst->value
                                  : value.value > measured.worst->value)) {
      measured.worst = value;
    }
  }
  measured.passed = measured.worst && measured.unmeasured.empty() && within &&
                    (!figure.ascending || measured.ascends);
}

}  // namespace

std::vector<MeasuredFigure> measure_figures(const StageRecord& record) {
  std::vector<MeasuredFigure> all;
  for (const SceneFigure& figure : record.scene.figures) {
    MeasuredFigure measured;
    measured.figure = figure;
    if (figure.kind == SceneFigureKind::kStepTime) {
      measured.bodies.push_back({{}, record.mean_step_ms, 0.0, record.step_count(), 0});
    }
    for (const FigureUser& user : figure_users(record.scene, figure)) {
      const RecordedBody body(record, user.body);
      const FigureTask task{
          record, figure, user, body.view(), {figure.from_s, figure.to_s}};
      Measured value = measure_one(task);
      if (!value) {
        measured.unmeasured.push_back(record.bodies[user.body].id);
        continue;
      }
      value->body = record.bodies[user.body].id;
      measured.bodies.push_back(*std::move(value));
    }
    judge(measured);
    all.push_back(std::move(measured));
  }
  return all;
}

}  // namespace marey::app
