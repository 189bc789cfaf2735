// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "app/stage/stage_record.h"
#include "core/base/result.h"
#include "core/engine/scene.h"

namespace marey::app {

/// Returns the name of the load that a body carries in a hand (0 left, 1 right) during
/// the whole scene.
[[nodiscard]] std::string hand_load_name(std::size_t side);
/// Returns the name of the load of a `carry`, by its position in Scene::script.
[[nodiscard]] std::string carry_load_name(std::size_t action);

/// Makes or reads the bodies of a scene, in the order of scene_bodies(): mannequins,
/// avatars, skeletons, characters. Their loads are those of the hands and of the script.
/// Errors (bad input, with the body): those of read_skeleton(), load_character(),
/// map_body() and make_character(); a load in a hand that the body does not have.
[[nodiscard]] Result<std::vector<StageBody>> load_stage_bodies(const Scene& scene);

}  // namespace marey::app
