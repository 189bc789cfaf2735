// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/stage/figures/measure_figures.h"
#include "app/stage/run/stage_bodies.h"
#include "app/stage/run/stage_record.h"
#include "core/base/result.h"
#include "core/finding.h"

namespace marey::app {

/// A scene that was run, and its figures.
struct StageResult {
  const StageRecord& record;
  const StageCast& cast;
  std::vector<MeasuredFigure> figures{};
  std::vector<Error> problems{};  ///< Actions that could not begin.
};

/// Checks that results may be written to a folder: it does not exist, is empty, or has a
/// stage.json. Errors (bad input): another folder or file is there.
[[nodiscard]] Status check_stage_folder(const std::filesystem::path& folder);

/// Returns the content of stage.json (docs/formats/stage.md). Only mean_step_ms and
/// figures of the kind step_time depend on the clock.
[[nodiscard]] nlohmann::ordered_json stage_json(const StageResult& result);

/// Returns one line for each figure: `parry of red: 7.1 mm at 1.83 s (red.2), limit 10`.
[[nodiscard]] std::vector<std::string> stage_lines(const StageResult& result);

/// Returns a poor finding for each action that could not begin and each figure that does
/// not meet its bounds.
[[nodiscard]] std::vector<Finding> assess_stage(const StageResult& result);

/// Writes NAME.glb (unless the scene does without), trials.csv (if throws of a list of
/// trials were played) and stage.json to a folder that
/// appears as a whole. A folder that exists is replaced if it has a stage.json. Returns
/// the files.
/// Errors: the folder exists and is not of a scene; the disk.
[[nodiscard]] Result<std::vector<std::filesystem::path>> write_stage(
    const StageResult& result, const std::filesystem::path& folder);

}  // namespace marey::app
