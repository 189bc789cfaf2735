// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/figures/figure_users.h"

#include <algorithm>
#include <optional>

#include <glm/geometric.hpp>

namespace marey::app {

std::vector<FigureUser> figure_users(const Scene& scene, const SceneFigure& figure) {
  std::vector<FigureUser> users;
  for (const std::string& name : figure.bodies) {
    const std::optional<SceneMembers> members = members_of(scene, name);
    if (!members) continue;
    for (std::size_t k = 0; k < members->count; ++k) {
      users.push_back({members->first + k, k});
    }
  }
  return users;
}

std::vector<double> event_times_s(const StageRecord& record,
                                  const SceneFigure& figure,
                                  const FigureUser& user) {
  std::vector<double> times_s;
  for (const StageActionRun& run : record.actions) {
    const SceneAction& action = record.scene.script[run.action];
    if (action.id != figure.action) continue;
    const auto members = members_of(record.scene, action.body);
    if (!members || run.body != members->partner(user.member)) continue;
    for (const StageEvent& event : run.events) {
      if (event.name == figure.event) times_s.push_back(event.time_s);
    }
  }
  return times_s;
}

std::vector<double> arrival_times_s(const FigureBody& body,
                                    const StageActionRun& run,
                                    std::span<const glm::dvec3> targets_in_world) {
  constexpr double kJump_m = 0.2;
  std::vector<double> times_s;
  if (body.times_s.empty()) return times_s;
  const double end_s = std::min(run.end_s, body.times_s.back());
  for (std::size_t step = 1; step < targets_in_world.size(); ++step) {
    const double time_s = body.times_s[step - 1];
    if (time_s <= run.start_s || time_s >= end_s) continue;
    if (glm::distance(targets_in_world[step - 1], targets_in_world[step]) > kJump_m) {
      times_s.push_back(time_s);
    }
  }
  times_s.push_back(end_s);
  return times_s;
}

}  // namespace marey::app
