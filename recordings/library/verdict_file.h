// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/frame_range.h"
#include "core/base/result.h"
#include "core/library/clip_record.h"

namespace marey::recordings {

/// Name of the table of corrections in labels/.
inline constexpr std::string_view kVerdictFile = "verdicts.csv";
/// VerdictCorrection::figure for the quality of the whole clip.
inline constexpr std::string_view kQualityFigure = "quality";

/// A verdict by a person instead of the measured one.
struct VerdictCorrection {
  std::string clip;    ///< Id of the clip.
  std::string figure;  ///< ClipFigure::name, or kQualityFigure.
  /// The place in the clip that the person looked at; nullopt: the whole clip.
  std::optional<FrameRange> frames = std::nullopt;
  Verdict verdict = Verdict::kPass;
  std::string by;    ///< Empty: unknown.
  std::string note;  ///< For people.
  int line = 0;      ///< In its file; 0: unknown.
};

/// Reads a table of corrections (docs/formats/library.md): comma-separated, with the
/// columns clip, figure, frames, verdict, by, note. Errors (kBadInput), with file, line
/// and column: those of parse_labels(); a verdict that is none; frames that are neither
/// "12" nor "12-40". Linear.
[[nodiscard]] Result<std::vector<VerdictCorrection>> parse_verdicts(
    std::string_view text, const std::string& file);

/// Applies parse_verdicts() to the file at `path`.
[[nodiscard]] Result<std::vector<VerdictCorrection>> read_verdicts(
    const std::filesystem::path& path);

/// Returns the text of a table of corrections. parse_verdicts() returns the same rows.
/// Same input, same bytes. Precondition: texts have no line ends and no blanks at their
/// ends.
[[nodiscard]] std::string verdicts_text(std::span<const VerdictCorrection> rows);

/// Appends a correction to the table at `path`, which is created if it does not exist,
/// and replaced as a whole. Line ends and other control characters in texts become
/// blanks. Errors: those of read_verdicts(), so that a table with a mistake stays as it
/// is; those of write_file().
[[nodiscard]] Status add_verdict(const std::filesystem::path& path,
                                 VerdictCorrection correction);

}  // namespace marey::recordings
