// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "app/stage/run/stage_record.h"
#include "core/engine/scene_figure.h"

namespace marey::app {

/// The value of a figure for one body; for an event or a throw the worst of them.
struct BodyFigure {
  std::string body;
  double value = 0.0;      ///< In the unit of the kind.
  double time_s = 0.0;     ///< The worst step, event or throw.
  std::size_t count = 0;   ///< Values of which this is the worst.
  std::size_t beyond = 0;  ///< kWristError: steps in which the target is out of reach.
};

/// A figure of a scene as measured.
struct MeasuredFigure {
  SceneFigure figure;
  std::vector<BodyFigure> bodies;       ///< All with a value, in the order of the figure.
  std::vector<std::string> unmeasured;  ///< Bodies without a value.
  /// The smallest value with SceneFigure::min alone, else the largest. nullopt: no value.
  std::optional<BodyFigure> worst;
  bool ascends = true;  ///< Each body's value exceeds that of the body before it.
  /// True if bounds and order are met and every body has a value.
  bool passed = false;
};

/// Computes all figures of a scene, in the order of its file. Positions are those of the
/// recorded postures, by forward kinematics. Precondition: the record is complete. Linear
/// in steps, bodies and figures.
[[nodiscard]] std::vector<MeasuredFigure> measure_figures(const StageRecord& record);

}  // namespace marey::app
