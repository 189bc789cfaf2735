// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "library/quality/found_figure.h"

#include "core/library/clip_record.h"

namespace marey::library {

/// All statements about the rate of one motion. nullopt: not stated.
struct RateWitnesses {
  std::optional<double> file_hz = std::nullopt;    ///< By the file itself.
  std::optional<double> table_hz = std::nullopt;   ///< By an index table.
  std::optional<double> option_hz = std::nullopt;  ///< By library.toml.
  /// Duration of the motion by an index table: a table of original recordings may
  /// describe a file at another rate. [s]
  std::optional<double> table_duration_s = std::nullopt;
  int frames = 0;  ///< Number of frames in the file.
};

/// The rate of a motion, and its contradictions.
struct StatedRate {
  double hz = 0.0;  ///< The rate in use.
  RateBasis basis = RateBasis::kFile;
  /// "rate_stated_ratio", an outside figure of measure_quality(): the largest ratio
  /// between the rate in use and a different statement, at least 1. It is 1 if all agree
  /// within 1 %, or if a second witness confirms the rate in use.
  FoundFigure figure{"rate_stated_ratio"};
};

/// Returns true if the duration of a table is that of the file's own frames and rate,
/// within 2 % or two frames.
[[nodiscard]] bool is_resampled_copy(const RateWitnesses& witnesses);

/// Chooses the rate: that of the option, else the table's, else the file's. A file is not
/// contradicted by a table whose duration is that of the file's own frames and rate,
/// within 2 % or two frames: such a file is a resampled copy, and its rate is in use,
/// with the basis kFile if there is no option. nullopt: there is no statement, or the
/// chosen rate is not positive.
[[nodiscard]] std::optional<StatedRate> choose_rate(const RateWitnesses& witnesses);

}  // namespace marey::library
