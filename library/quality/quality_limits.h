// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "core/library/clip_record.h"
#include "core/library/library_settings.h"

namespace marey::library {

/// A figure of the quality gate.
struct FigureRule {
  std::string_view figure;  ///< ClipFigure::name; the unit is a part of it.
  std::string_view kind;    ///< ClipProblem::kind of its problems.
  double warn = 0.0;        ///< Above this value a warning,
  double fail = 0.0;        ///< and above this one a failure.
  /// True: the figure does not follow from the motion. Its reader or solver passes it to
  /// measure_quality(); other clips do not have it.
  bool is_outside = false;
  /// False: the figure is only reported, without limits. Limits may be 0.
  bool is_judged = true;
};

/// Returns all figures of the gate with their default limits. docs/accuracy/
/// library_quality.md states the data on which the limits were chosen. The order of
/// the rules is that of explanation: the first kind of a clip with several problems
/// causes the others most likely.
[[nodiscard]] std::span<const FigureRule> figure_rules();

/// The rules with a library's own limits in place of the defaults.
class QualityLimits {
 public:
  /// Limits of figures that do not exist are ignored: the reader of library.toml reports
  /// them. A figure with own limits is judged.
  explicit QualityLimits(std::span<const QualityLimit> own);

  /// Precondition: the figure is one of figure_rules().
  [[nodiscard]] const FigureRule& operator[](std::string_view figure) const;
  /// Returns the verdict on a value; nullopt: the figure is only reported.
  [[nodiscard]] std::optional<Verdict> verdict(std::string_view figure,
                                               double value) const;
  [[nodiscard]] std::span<const FigureRule> rules() const { return rules_; }

 private:
  std::vector<FigureRule> rules_;
};

}  // namespace marey::library
