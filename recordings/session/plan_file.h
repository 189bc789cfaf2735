// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>

#include "core/base/result.h"
#include "core/body.h"
#include "core/camera.h"
#include "core/camera_quality.h"

namespace marey::recordings {

/// The part of the floor to be captured, and the grid step of its evaluation.
struct PlannedVolume {
  glm::dvec2 min_m{-2.0};  ///< Minimum x and z in the world.
  glm::dvec2 max_m{2.0};   ///< Maximum x and z in the world.
  double step_m = 0.25;
};

/// Default edge of a tag's black square. [m]
inline constexpr double kDefaultPlannedTag_m = 0.08;

/// Content of plan.toml: planned cameras. Absent values were not given.
struct CapturePlan {
  std::vector<Camera> cameras;  ///< At least one; names differ.
  std::optional<double> tag_size_m;
  std::optional<double> stature_m;
  std::optional<PlannedVolume> volume;
  std::vector<TagOnSegment> tags;      ///< On the body; ids from 0 in the file's order.
  std::vector<CameraQuality> quality;  ///< Per camera of a calibration; empty for a plan.
};

/// Reads a plan.toml (docs/formats/plan.md), or the cameras of a calibration.toml like
/// parse_calibration(): a file without [[camera]]. Planned cameras have no distortion and
/// level images. `file` is the name of the text in error messages.
///
/// Errors (kBadInput), with the line: not TOML; a key unknown, missing, of the wrong type
/// or out of range; a name twice; a camera whose target is itself or straight above or
/// below it; both field_of_view_deg and focal_px; a tag on no segment; a volume without
/// extent, or of more than 40 000 grid points; a position or a corner beyond a kilometre
/// from the origin.
[[nodiscard]] Result<CapturePlan> parse_plan(std::string_view text,
                                             const std::string& file);

/// Applies parse_plan() to the file at `path`.
[[nodiscard]] Result<CapturePlan> read_plan(const std::filesystem::path& path);

}  // namespace marey::recordings
