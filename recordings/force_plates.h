// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/result.h"
#include "core/time.h"
#include "recordings/file_axes.h"

namespace marey::recordings {

/// What a force plate does to whoever is on it, at one instant.
struct PlateSample {
  glm::dvec3 force_in_world{0.0};  ///< [N]; up when somebody stands on it.
  /// Where on the surface it acts. nullopt when it is too small to say. [m]
  std::optional<glm::dvec3> centre_in_world;
  /// What of the moment is left there, about the plate's normal. [N m]
  glm::dvec3 free_moment_in_world{0.0};
};

struct ForcePlate {
  int type = 2;
  std::array<glm::dvec3, 4> corners_in_world{};  ///< As in the file, from the first. [m]
  std::vector<PlateSample> samples;
};

struct ForcePlates {
  FrameRate rate;
  double start_s = 0.0;  ///< Of the first sample, on the clock of the markers.
  std::vector<ForcePlate> plates;
  /// What was odd, or left out. Sentences without a full stop.
  std::vector<std::string> notes;
};

struct ForcePlateOptions {
  /// Below this, along the plate's normal, the centre of pressure is not told. [N]
  double least_force_N = 20.0;
};

/// The force plates of a C3D, of type 1 (force and centre of pressure), 2 (force and
/// moment), 3 (eight channels of a Kistler plate) and 4 (as 2, by a calibration matrix);
/// after the C3D User Guide, "FORCE_PLATFORM". `axes` are those of the file
/// (read_markers()). None when it has none; plates of other types, without channels or
/// without corners, are left out and said in the notes.
///
/// Forces are as they were recorded: FORCE_PLATFORM:ZERO, which would make somebody
/// weightless who stands there from the start, is not applied. If on the whole they push
/// down they are the body's on the plate, and are turned round.
/// Errors as C3dReader's. Cost: memory for every sample, 80 bytes each.
[[nodiscard]] Result<ForcePlates> read_force_plates(
    const std::filesystem::path& path,
    const FileAxes& axes,
    const ForcePlateOptions& options = {});

/// The same of a file in memory; `name` is what messages call it.
[[nodiscard]] Result<ForcePlates> parse_force_plates(
    const std::string& bytes,
    const std::string& name,
    const FileAxes& axes,
    const ForcePlateOptions& options = {});

}  // namespace marey::recordings
