// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/result.h"
#include "core/base/time.h"
#include "recordings/markers/file_axes.h"

namespace marey::recordings {

/// Force of a force plate on the subject at one instant.
struct PlateSample {
  glm::dvec3 force_in_world{0.0};  ///< [N]; up when a subject stands on the plate.
  /// Centre of pressure on the surface. nullopt if the force is too small. [m]
  std::optional<glm::dvec3> centre_in_world;
  /// Remaining moment at the centre of pressure, about the plate's normal. [N m]
  glm::dvec3 free_moment_in_world{0.0};
};

struct ForcePlate {
  int type = 2;
  std::array<glm::dvec3, 4> corners_in_world{};  ///< As in the file, from the first. [m]
  std::vector<PlateSample> samples;
};

struct ForcePlates {
  FrameRate rate;
  double start_s = 0.0;  ///< Time of the first sample, on the clock of the markers.
  std::vector<ForcePlate> plates;
  /// Anomalies and omitted plates. Sentences without a full stop.
  std::vector<std::string> notes;
};

struct ForcePlateOptions {
  /// Minimum force along the plate's normal for which a centre of pressure is computed.
  /// [N]
  double min_force_N = 20.0;
};

/// Reads the force plates of a C3D, of type 1 (force and centre of pressure), 2 (force
/// and moment), 3 (eight channels of a Kistler plate) and 4 (as 2, with a calibration
/// matrix). Source: the C3D User Guide, "FORCE_PLATFORM". `axes` are those of the file
/// (read_markers()). Empty if the file has no plates. Plates of other types, without
/// channels or without corners, are omitted and reported in the notes.
///
/// Forces are as recorded: FORCE_PLATFORM:ZERO is not applied, because it would remove
/// the weight of a subject who stands on the plate from the start. If the forces point
/// downward on average, they are those of the body on the plate, and their sign is
/// reversed. Errors: those of C3dReader. Cost: 80 bytes of memory for each sample.
[[nodiscard]] Result<ForcePlates> read_force_plates(
    const std::filesystem::path& path,
    const FileAxes& axes,
    const ForcePlateOptions& options = {});

/// Reads the force plates of a file in memory; `name` is its name in messages.
[[nodiscard]] Result<ForcePlates> parse_force_plates(
    const std::string& bytes,
    const std::string& name,
    const FileAxes& axes,
    const ForcePlateOptions& options = {});

}  // namespace marey::recordings
