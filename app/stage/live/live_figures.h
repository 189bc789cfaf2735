// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "app/stage/scene_run.h"
#include "core/base/ids.h"
#include "core/transform.h"
#include "live/page/page_run.h"

namespace marey::app {

/// Measures the figures of a scene while it runs: distances of points from targets
/// (wrist_error, clearance) and the time of a step. Other figures need the whole run;
/// they have no value here. A value is the worst one of all bodies since the last report.
class LiveFigures {
 public:
  explicit LiveFigures(const SceneRun& run);

  /// Adds the last step. Allocates nothing.
  void add(const SceneRun& run);
  /// Adds the time that `steps` steps took, by the clock.
  void add_step_time(double total_s, int steps);
  /// Returns all figures of the scene, in the order of its file, and begins anew. A
  /// figure without a value since the last report keeps the one before.
  [[nodiscard]] std::vector<live::PageRunFigure> report();
  /// Forgets all values, for a new run.
  void reset();

 private:
  /// A point of a body whose distance from a target is measured.
  struct Point {
    std::size_t figure = 0;
    std::size_t body = 0;
    std::size_t target = 0;
    JointIndex joint{};
    glm::dvec3 offset_in_joint{0.0};
    /// Upper joint of its arm and the reach from there; nullopt: no arm.
    std::optional<JointIndex> shoulder{};
    double reach_m = 0.0;
  };
  void add_points(const SceneRun& run, std::size_t figure);
  void add_value(std::size_t figure, double value_mm);
  [[nodiscard]] std::optional<double> step_time_ms();

  Scene scene_;
  std::vector<Point> points_;                        ///< Ascending by body.
  std::vector<std::vector<RigidTransform>> joints_;  ///< By body; empty: not needed.
  std::vector<std::optional<double>> worst_;     ///< By figure, since the last report.
  std::vector<std::optional<double>> reported_;  ///< By figure.
  double busy_s_ = 0.0;
  long steps_ = 0;
};

}  // namespace marey::app
