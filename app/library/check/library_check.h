// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "library/quality/quality_limits.h"

#include "app/library/check/failed_source.h"
#include "core/library/clip_record.h"

namespace marey::app {

/// Number of verdicts: Verdict is an index below it.
inline constexpr std::size_t kVerdictCount = 3;

struct ClipTotal {
  int clips = 0;
  double hours = 0.0;
};

/// One figure over all clips that have it.
struct FigureSummary {
  std::string figure;
  std::string kind;        ///< Kind of its problems; empty: it is no figure of the gate.
  bool is_judged = false;  ///< FigureRule::is_judged; false: only reported.
  double warn = 0.0;       ///< Limits of the library.
  double fail = 0.0;
  int clips = 0;
  std::array<int, kVerdictCount> verdicts{};  ///< Clips by verdict.
  double median = 0.0;
  double p95 = 0.0;
  double max = 0.0;
  std::size_t worst_clip = 0;  ///< Index of the first clip with the maximum.
};

/// One kind of problem over all clips.
struct KindSummary {
  std::string kind;
  int clips = 0;
  int problems = 0;
  double seconds = 0.0;  ///< Frames with the problem, over their rate.
};

/// Quality of a library's clips, in numbers.
struct LibraryCheck {
  std::string library;            ///< Name in library.toml.
  std::string folder;             ///< As given, for commands in messages.
  std::string query;              ///< Selection of the clips; empty: all.
  std::vector<ClipRecord> clips;  ///< In the order of the index.
  std::vector<FailedSource> failed;
  ClipTotal total;
  std::array<ClipTotal, kVerdictCount> by_verdict;
  int duplicates = 0;
  /// Figures of the clips: those of figure_rules() in their order, then others by name.
  std::vector<FigureSummary> figures;
  std::vector<KindSummary> kinds;  ///< Descending by clips, then by name.
  /// Indexes of clips: the worst quality first, then more figures that fail or warn, then
  /// the largest excess over a limit.
  std::vector<std::size_t> worst_first;
};

/// Counts clips, figures and problems. The caller sets the names. Cost: n log n in clips.
/// Precondition: values of figures are finite.
[[nodiscard]] LibraryCheck check_library(std::vector<ClipRecord> clips,
                                         const library::QualityLimits& limits,
                                         std::vector<FailedSource> failed);

/// Returns the figure of a clip; nullptr: it does not have it.
[[nodiscard]] const ClipFigure* find_figure(const ClipRecord& clip,
                                            std::string_view figure);

/// Returns the worst verdict of the clip's figures of a kind of problem; kWarn if none
/// has a verdict that is worse.
[[nodiscard]] Verdict verdict_of_kind(const ClipRecord& clip, std::string_view kind);

/// Returns the unit of the values of a kind of problem, with a blank before it: " mm",
/// " cm/s", " deg", " s". It is that of the kind's figures (FigureRule::figure); empty:
/// they have none, or different ones.
[[nodiscard]] std::string unit_of_kind(std::string_view kind);

/// Start and end of frames of a clip, from its first frame. [s]
struct SecondsRange {
  double start_s = 0.0;
  double end_s = 0.0;  ///< After the last frame.
};
[[nodiscard]] SecondsRange seconds_of(const ClipRecord& clip, const FrameRange& frames);

}  // namespace marey::app
