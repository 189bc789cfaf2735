// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/stage/run/scene_run.h"

namespace marey::app {

/// A scene of three mannequins of different statures, with a target in the frame of each
/// ("left", for the left hand) and targets in the world ("cup"; "wall", which cannot be
/// dragged).
[[nodiscard]] SceneRunInput live_scene();

}  // namespace marey::app
