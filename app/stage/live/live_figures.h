// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "app/stage/run/scene_run.h"
#include "live/page/page_run.h"

namespace marey::app {

/// Figures of a scene while it runs: as measure_figures() computes them, over the steps
/// since the last report. So displacements of feet begin again with each report.
class LiveFigures {
 public:
  /// Notes the last step of the run. Without requests for reports, the record is emptied
  /// from time to time.
  void add(SceneRun& run);
  /// Returns all figures of the scene, in the order of its file, and empties the record
  /// of the run. A figure without a value since the last report keeps the one before.
  /// Linear in steps since then, bodies and figures.
  [[nodiscard]] std::vector<live::PageRunFigure> report(SceneRun& run);
  /// Forgets all values, for a new run.
  void reset() { reported_.clear(); }

 private:
  std::vector<std::optional<double>> reported_;  ///< By figure.
};

}  // namespace marey::app
