// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "library/export/licence_terms.h"
#include "library/export/split_clips.h"

#include "core/base/result.h"
#include "core/library/library_settings.h"

namespace marey::app {

/// Layouts of an exported library (docs/formats/library_exports.md).
enum class ExportFormat {
  kNpz,
  kBvh,
  kGlb,
  kVrma,
  kAmass,
  kJoints22,
  kShards,
  kPack,
  kMatching,
  kTable,
};

[[nodiscard]] std::span<const ExportFormat> export_formats();
/// Returns "npz", "joints22"...
[[nodiscard]] std::string_view name(ExportFormat format);
[[nodiscard]] std::optional<ExportFormat> export_format(std::string_view name);

/// Names and shares of splits; the shares add up to 1.
using SplitShares = std::vector<std::pair<std::string, double>>;

/// Settings of one export, with all defaults resolved.
struct ExportOptions {
  std::filesystem::path library;
  std::filesystem::path out;
  ExportFormat format = ExportFormat::kNpz;
  std::string query;  ///< As given, for the data sheet.
  /// "own": each clip's body; the name of a library::NamedSkeleton; else a body's file.
  std::string skeleton = "own";
  std::optional<double> rate_hz = std::nullopt;  ///< nullopt: each clip's own.
  bool adds_mirrored = false;
  bool starts_at_origin = false;
  SplitShares splits;
  library::SplitBy split_by = library::SplitBy::kSubject;
  library::LicenceAllowance allowance = {};
  bool replaces = false;  ///< An earlier export at `out` is replaced.
};

/// Returns the skeleton of an export. `given` is the option, empty without it. Without
/// it, the library's setting counts, but layouts that demand one skeleton for all clips
/// have their own: amass and joints22 "smpl22", pack and matching "marey".
[[nodiscard]] std::string skeleton_of_export(ExportFormat format,
                                             const std::string& given,
                                             const LibrarySettings& settings);

/// Reads shares such as "80/10/10" of train, val and test; two numbers are train and
/// test, one is train alone. Errors (kUsage): not one to three numbers from 0 to 100 that
/// add up to 100.
[[nodiscard]] Result<SplitShares> parse_split(const std::string& text);

/// Returns true if an export changes a clip of this rate by more than its format, in the
/// sense of licences: another skeleton, rate or place, a mirrored copy, or features
/// instead of the motion. A table has no motion and changes nothing.
[[nodiscard]] bool changes_clip(const ExportOptions& options, double clip_rate_hz);

}  // namespace marey::app
