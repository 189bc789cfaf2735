// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "library/quality/rate_witnesses.h"

#include "core/library/clip_record.h"
#include "core/motion.h"

namespace marey::app {

/// Rates of a motion. [Hz]
struct SourceRates {
  double file_hz = 0.0;          ///< By the file.
  bool file_is_guessed = false;  ///< The file states none; file_hz is a default.
  /// The rate that counts, by library::choose_rate(); file_hz if nothing states one.
  library::StatedRate used;

  [[nodiscard]] RateBasis basis() const { return used.basis; }
};

/// One motion of a source.
struct SourceMotion {
  /// In marey's frame: Y up, metres, bones marked (read_body()), at SourceRates::used.
  /// The height above the floor is the source's.
  Motion motion;
  /// Uncertainty, [frame][joint]; empty: unknown.
  std::vector<std::vector<JointUncertainty>> uncertainty;
  std::string body;  ///< Name of the body or trial in the source; empty: the only one.
  SourceRates rates;
  std::string subject;  ///< The person, if the source names one.
  /// Measured while reading: bones_mm, residual_mm, cleaned_mm...; without verdicts.
  /// Ascending by name.
  std::vector<ClipFigure> figures;
  /// Problems of all frames. "sides": left and right are exchanged. "fit": the solver
  /// reports poor results; the value is their number.
  std::vector<ClipProblem> problems;
  std::vector<ClipLabel> labels;     ///< Labels that the source has.
  std::vector<ClipEvent> events;     ///< Events that the source has.
  std::vector<std::string> remarks;  ///< Assumptions of the readers, and changes.
};

}  // namespace marey::app
