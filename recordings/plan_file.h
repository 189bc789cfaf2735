// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>

#include "core/body.h"
#include "core/camera.h"
#include "core/camera_quality.h"
#include "core/result.h"

namespace marey::recordings {

/// The part of the floor that is to be captured, and how finely to look at it.
struct PlannedVolume {
  glm::dvec2 least_m{-2.0};    ///< x and z in the world.
  glm::dvec2 greatest_m{2.0};  ///< Likewise.
  double step_m = 0.25;
};

/// Edge of a tag's black square where neither plan nor user say.
inline constexpr double kUsualPlannedTag_m = 0.08;

/// plan.toml: cameras as somebody would set them up. What is absent was not given.
struct CapturePlan {
  std::vector<Camera> cameras;  ///< At least one; names differ.
  std::optional<double> tag_size_m;
  std::optional<double> stature_m;
  std::optional<PlannedVolume> volume;
  std::vector<TagOnSegment> tags;      ///< On the body; ids from 0 in the file's order.
  std::vector<CameraQuality> quality;  ///< Per camera of a calibration; else empty.
};

/// Reads a plan.toml (docs/formats.md), or the cameras of a calibration.toml, as
/// parse_calibration() does: one that has no [[camera]]. Planned cameras have no
/// distortion and hold their pictures level. `file` is what error messages call the text.
///
/// Errors (kBadInput), with the line: not TOML; a key unknown, missing, of the wrong type
/// or out of range; a name twice; a camera that looks at itself or straight up or down;
/// both field_of_view_deg and focal_px; a tag on no segment; a volume without extent, or
/// of more than 40 000 places; a place or a corner beyond a kilometre from the origin.
[[nodiscard]] Result<CapturePlan> parse_plan(std::string_view text,
                                             const std::string& file);

/// parse_plan() of the file at `path`.
[[nodiscard]] Result<CapturePlan> read_plan(const std::filesystem::path& path);

}  // namespace marey::recordings
