// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "app/stage/figures/figure_body.h"
#include "app/stage/run/stage_record.h"
#include "core/engine/scene.h"

namespace marey::app {

/// A body for which a figure is measured.
struct FigureUser {
  std::size_t body = 0;    ///< Position in scene_bodies().
  std::size_t member = 0;  ///< Position in its group, which pairs it with others.
};

/// Returns the bodies of a figure in the order of its file.
[[nodiscard]] std::vector<FigureUser> figure_users(const Scene& scene,
                                                   const SceneFigure& figure);

/// Returns the times at which a figure's event occurred in its action. The action may be
/// that of another group: then of the member with the user's number. [s]
[[nodiscard]] std::vector<double> event_times_s(const StageRecord& record,
                                                const SceneFigure& figure,
                                                const FigureUser& user);

/// Returns the times at which a steered body must have arrived: the step before each jump
/// of the target by more than 0.2 m, and the end of the action or of the scene. [s]
[[nodiscard]] std::vector<double> arrival_times_s(
    const FigureBody& body,
    const StageActionRun& run,
    std::span<const glm::dvec3> targets_in_world);

}  // namespace marey::app
