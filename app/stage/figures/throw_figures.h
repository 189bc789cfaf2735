// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "app/stage/run/stage_record.h"
#include "app/stage/run/trial_log.h"
#include "core/engine/scene_figure.h"

namespace marey::app {

/// Returns the deviation of a throw from the asked one, in the unit of the kind: place of
/// the wrist [mm], angle between both directions of the ball [deg], speed [percent],
/// time of the release [ms]. Precondition: a kind of throws.
[[nodiscard]] double throw_figure(SceneFigureKind kind, const StageThrow& thrown);

/// Returns the rows of a study's table, one for each throw of a list of trials, in the
/// order of their releases. Arrivals and the keeper's response are not known.
[[nodiscard]] std::vector<TrialRow> trial_rows(const StageRecord& record);

/// Converts StageThrow::asked or StageThrow::measured to the units of a trial list.
[[nodiscard]] TrialValues trial_values(const std::array<double, 7>& values);

}  // namespace marey::app
