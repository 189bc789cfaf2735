// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/figures/throw_figures.h"

#include <cmath>
#include <utility>
#include <variant>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "core/base/assert.h"

namespace marey::app {
namespace {

enum ThrowPlace : std::size_t {
  kLeft,
  kUp,
  kForward,
  kAzimuth,
  kElevation,
  kSpeed,
  kRelease
};

glm::dvec3 place_of(const std::array<double, 7>& values) {
  return {values[kLeft], values[kUp], values[kForward]};
}

glm::dvec3 direction_of(const std::array<double, 7>& values) {
  const double level = std::cos(values[kElevation]);
  return {level * std::sin(values[kAzimuth]),
          std::sin(values[kElevation]),
          level * std::cos(values[kAzimuth])};
}

}  // namespace

double throw_figure(SceneFigureKind kind, const StageThrow& thrown) {
  const auto& asked = thrown.asked;
  const auto& measured = thrown.measured;
  switch (kind) {
    case SceneFigureKind::kThrowPlace:
      return 1000.0 * glm::distance(place_of(asked), place_of(measured));
    case SceneFigureKind::kThrowDirection: {
      const glm::dvec3 a = direction_of(asked);
      const glm::dvec3 b = direction_of(measured);
      return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
    }
    case SceneFigureKind::kThrowSpeed:
      return 100.0 * std::abs(measured[kSpeed] / asked[kSpeed] - 1.0);
    default:
      break;
  }
  MAREY_ASSERT(kind == SceneFigureKind::kReleaseTime);
  return 1000.0 * std::abs(measured[kRelease] - asked[kRelease]);
}

TrialValues trial_values(const std::array<double, 7>& values) {
  TrialValues out;
  out.place_m = place_of(values);
  out.azimuth_deg = glm::degrees(values[kAzimuth]);
  out.elevation_deg = glm::degrees(values[kElevation]);
  out.speed_m_s = values[kSpeed];
  out.release_s = values[kRelease];
  return out;
}

std::vector<TrialRow> trial_rows(const StageRecord& record) {
  std::vector<TrialRow> out;
  for (const StageThrow& thrown : record.throws) {
    const auto* deed = std::get_if<SceneThrow>(&record.scene.script[thrown.action].deed);
    if (deed == nullptr || !thrown.trial) continue;
    const auto list = record.trials.find(deed->trials);
    if (list == record.trials.end()) continue;
    const PlannedTrial planned = trial_order(list->second)[*thrown.trial];
    const ThrowTrial& trial = list->second.trials[planned.trial];
    TrialRow row;
    row.number = static_cast<int>(*thrown.trial) + 1;
    row.parameter = kThrowParameters[static_cast<std::size_t>(trial.parameter)];
    row.value = trial.value;
    row.repetition = planned.repetition + 1;
    row.start_s = thrown.start_s;
    row.asked = trial_values(thrown.asked);
    row.measured = trial_values(thrown.measured);
    row.release_s = thrown.release_s;
    out.push_back(std::move(row));
  }
  return out;
}

}  // namespace marey::app
