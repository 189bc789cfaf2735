// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/live/live_figures.h"

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "retarget/constraints/resolve_segment.h"

namespace marey::app {
namespace {

constexpr double kMillimetres = 1000.0;

bool is_distance(SceneFigureKind kind) {
  return kind == SceneFigureKind::kWristError || kind == SceneFigureKind::kClearance;
}

std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

std::string bound_text(const SceneFigure& figure) {
  std::string text;
  if (figure.min) text = "\u2265 " + number_text(*figure.min);
  if (figure.max)
    text += (text.empty() ? "" : ", ") + ("\u2264 " + number_text(*figure.max));
  return text;
}

std::optional<bool> is_passed(const SceneFigure& figure, std::optional<double> value) {
  if (!value || (!figure.min && !figure.max)) return std::nullopt;
  return (!figure.min || *value >= *figure.min) && (!figure.max || *value <= *figure.max);
}

std::optional<std::size_t> target_position(const Scene& scene, const std::string& id) {
  for (std::size_t t = 0; t < scene.targets.size(); ++t) {
    if (scene.targets[t].id == id) return t;
  }
  return std::nullopt;
}

}  // namespace

LiveFigures::LiveFigures(const SceneRun& run)
    : scene_(run.scene()),
      joints_(run.size()),
      worst_(scene_.figures.size()),
      reported_(scene_.figures.size()) {
  for (std::size_t f = 0; f < scene_.figures.size(); ++f) {
    if (is_distance(scene_.figures[f].kind)) add_points(run, f);
  }
  std::stable_sort(points_.begin(), points_.end(), [](const Point& a, const Point& b) {
    return a.body < b.body;
  });
}

/// Adds the points of all bodies of a figure.
void LiveFigures::add_points(const SceneRun& run, std::size_t figure) {
  const SceneFigure& one = scene_.figures[figure];
  const auto target = target_position(scene_, one.target);
  if (!target) return;
  for (const std::string& name : one.bodies) {
    const auto members = members_of(scene_, name);
    for (std::size_t k = 0; members && k < members->count; ++k) {
      const std::size_t b = members->first + k;
      const StageBody& body = run.body(b);
      const Skeleton& skeleton = body.character.skeleton;
      const auto joint = retarget::resolve_segment(skeleton, one.point.segment);
      if (!joint) continue;
      Point point{figure, b, *target, *joint};
      const glm::dquat t_pose = body.map.joints[index(*joint)].t_pose_from_joint;
      point.offset_in_joint = glm::conjugate(t_pose) * one.point.offset_in_t_pose;
      for (std::size_t side = 0; side < 2; ++side) {
        const auto& arm = body.map.limbs[side];
        if (!arm || *joint != arm->end) continue;
        point.shoulder = arm->upper;
        point.reach_m = arm->length_m() + glm::length(point.offset_in_joint);
      }
      joints_[b].resize(skeleton.joints.size());
      points_.push_back(point);
    }
  }
}

void LiveFigures::add_value(std::size_t figure, double value_mm) {
  std::optional<double>& worst = worst_[figure];
  const bool is_clearance = scene_.figures[figure].kind == SceneFigureKind::kClearance;
  if (!worst || (is_clearance ? value_mm < *worst : value_mm > *worst)) worst = value_mm;
}

void LiveFigures::add(const SceneRun& run) {
  std::optional<std::size_t> posed;
  for (const Point& point : points_) {
    if (run.time_s() < scene_.figures[point.figure].from_s) continue;
    std::vector<RigidTransform>& joints = joints_[point.body];
    if (posed != point.body) {
      world_from_joints(
          run.body(point.body).character.skeleton, run.pose(point.body), joints);
      posed = point.body;
    }
    const glm::dvec3 target = run.target_in_world(point.target, point.body);
    if (point.shoulder &&
        scene_.figures[point.figure].kind == SceneFigureKind::kWristError &&
        glm::distance(joints[index(*point.shoulder)].translation, target) >
            point.reach_m) {
      continue;
    }
    const glm::dvec3 place = joints[index(point.joint)] * point.offset_in_joint;
    add_value(point.figure, kMillimetres * glm::distance(place, target));
  }
}

void LiveFigures::add_step_time(double total_s, int steps) {
  busy_s_ += total_s;
  steps_ += steps;
}

std::optional<double> LiveFigures::step_time_ms() {
  if (steps_ == 0) return std::nullopt;
  const double mean_ms = 1000.0 * busy_s_ / static_cast<double>(steps_);
  busy_s_ = 0.0;
  steps_ = 0;
  return mean_ms;
}

std::vector<live::PageRunFigure> LiveFigures::report() {
  const std::optional<double> step_ms = step_time_ms();
  std::vector<live::PageRunFigure> out;
  for (std::size_t f = 0; f < scene_.figures.size(); ++f) {
    const SceneFigure& figure = scene_.figures[f];
    const SceneFigureRule& rule = rule_of(figure.kind);
    if (figure.kind == SceneFigureKind::kStepTime) worst_[f] = step_ms;
    if (worst_[f]) reported_[f] = std::exchange(worst_[f], std::nullopt);
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

void LiveFigures::reset() {
  std::fill(worst_.begin(), worst_.end(), std::nullopt);
  std::fill(reported_.begin(), reported_.end(), std::nullopt);
}

}  // namespace marey::app
