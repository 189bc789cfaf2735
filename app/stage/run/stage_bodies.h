// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "app/stage/run/stage_record.h"
#include "core/base/result.h"
#include "core/engine/scene.h"
#include "recordings/body/mesh.h"

namespace marey::app {

/// The bodies of a scene, with their surfaces.
struct StageCast {
  std::vector<StageBody> bodies{};  ///< One for each of scene_bodies(), in its order.
  /// Bound to the body's skeleton; nullopt: the body's file has no surface that can be
  /// bound to it.
  std::vector<std::optional<recordings::SkinnedMesh>> meshes{};
};

/// Makes the mannequins and reads the avatars, skeletons and characters of a scene. Hand
/// loads become loads of the character. A file that several bodies use is read once.
/// Errors (bad input): those of read_body(), load_character(), map_body() and
/// make_character(), and of reading constraints, each with its file.
[[nodiscard]] Result<StageCast> read_stage_cast(const Scene& scene);

}  // namespace marey::app
