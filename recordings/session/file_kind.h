// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/base/result.h"

namespace marey::recordings {

/// The kinds of files whose extension does not determine their content.
enum class FileKind {
  kUnknown,
  // TOML:
  kSession,
  kCalibration,
  kSubject,
  kPlan,
  kCharacter,
  kFloor,
  kBoneMap,
  kMarkerMap,
  kEditRecipe,
  kScene,
  kTrials,
  // XML:
  kConstraints,
  kLenses,  ///< A calibration of another program, also in YAML.
  // Tables:
  kJoints,
  kSegments,
  kPlaces,
  kDetections,
  kRepair,
  // Databases:
  kTake,
  kLiveTake,
};

/// Returns the kind of a .toml, .xml, .yaml, .yml, .csv or .sqlite file, by its first
/// keys, its root element, its header or its application number; kUnknown for everything
/// else. Its reader checks the rest. Cost: reads the file.
///
/// Errors (kBadInput): the file cannot be read, or is TOML with a syntax error.
[[nodiscard]] Result<FileKind> file_kind(const std::filesystem::path& path);

}  // namespace marey::recordings
