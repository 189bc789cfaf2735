// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/result.h"

namespace marey::recordings {

/// Positions of the joints and of the lowest skin vertex during a glTF file's first
/// animation.
struct PosedPlaces {
  /// World positions of the joints, frame by frame, in the file's unit and axes.
  std::vector<std::vector<glm::dvec3>> joints;
  /// World Y of the lowest vertex of all skins, frame by frame; empty without a skin.
  std::vector<double> lowest_skin;
};

/// Plays a .glb, .vrm, .vrma or .gltf file as the specification of glTF 2.0 defines it:
/// with translations and scales of all nodes, and each skin by its inverse bind matrices.
/// The result is that of other programs, whereas read_character() returns a skeleton of
/// rigid bones. Frames are those of read_character(); none without an animation. A VRM
/// 0.x is not turned. Vertices keep four joints.
///
/// Errors: those of read_character(). Cost: linear in frames times vertices.
[[nodiscard]] Result<PosedPlaces> read_posed_places(const std::filesystem::path& path);

}  // namespace marey::recordings
