// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/library/sources/list_sources.h"
#include "core/base/result.h"
#include "core/library/clip_record.h"
#include "core/library/library_settings.h"
#include "core/motion.h"

namespace marey::app {

/// Rates of a source, from all places that state one. [Hz]
struct SourceRates {
  double file_hz = 0.0;
  bool file_is_guessed = false;     ///< The file states none; file_hz is a default.
  std::optional<double> table_hz;   ///< Rate in the index table.
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
  std::vector<ClipFigure> figures;
  std::vector<ClipProblem> problems;  ///< "rate" and "sides"; frames are all frames.
  std::vector<ClipLabel> labels;      ///< Labels that the source has.
  std::vector<ClipEvent> events;      ///< Events that the source has.
  std::vector<std::string> remarks;   ///< Assumptions of the readers, and changes.
};

struct ReadSourceOptions {
  CleanBy clean = CleanBy::kNone;
  std::optional<double> table_rate_hz;  ///< Rate of the index table for this file.
  /// Folder for temporary results of a solve; empty: the system's. They are removed.
  std::filesystem::path scratch;
};

/// Reads all motions of a source, each on its own body: motion files as read_motion();
/// markers by the steps of `marey repair` and `marey fit`; sessions and takes by those of
/// `marey process`; recipes rendered. The source and its folder are not changed. The
/// result depends on the source's files and the options alone, not on the number of
/// threads. Runs in a forked child process.
/// Errors, with the file: those of the readers and solvers; a rate that is not 0.1 to
/// 2000 Hz; a cleaning that this kind of source does not support.
[[nodiscard]] Result<std::vector<SourceMotion>> read_source(
    const SourceFile& file,
    const LibrarySource& source,
    const ReadSourceOptions& options = {});

}  // namespace marey::app
