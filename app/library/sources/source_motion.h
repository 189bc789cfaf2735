// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/library/clip_record.h"
#include "core/motion.h"

namespace marey::app {

/// Rates of a source, from all places that state one. [Hz]
struct SourceRates {
  double file_hz = 0.0;
  bool file_is_guessed = false;     ///< The file states none; file_hz is a default.
  std::optional<double> table_hz;   ///< Rate in the index table.
  std::string table_evidence;       ///< IndexEntry::evidence.
  std::optional<double> option_hz;  ///< LibrarySource::rate_hz.

  /// Returns the rate that counts: the option's, else the table's, else the file's.
  [[nodiscard]] double used_hz() const {
    return option_hz.value_or(table_hz.value_or(file_hz));
  }
  [[nodiscard]] RateBasis basis() const {
    if (option_hz) return RateBasis::kOption;
    return table_hz ? RateBasis::kTable : RateBasis::kFile;
  }
  /// Returns the contradiction between stated rates, as a sentence; nullopt: they agree
  /// within 0.5 %. A guessed rate contradicts nothing.
  [[nodiscard]] std::optional<std::string> contradiction() const;
};

/// One motion of a source.
struct SourceMotion {
  /// In marey's frame: Y up, metres, bones marked (read_body()), at SourceRates::used_hz.
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
