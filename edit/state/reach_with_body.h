// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "edit/state/edit_state.h"
#include <glm/vec3.hpp>

#include "core/base/frame_range.h"
#include "core/base/result.h"
#include "core/humanoid.h"

namespace marey::edit {

struct BodyReach {
  double missed_m = 0.0;  ///< Largest distance of the bone from its target.
  int missed_frame = 0;
};

/// Moves a hand or a foot along a path with the help of the whole body (retarget::Adapter
/// with a DistanceToPoint constraint that follows the path). Feet other than `bone` keep
/// their places and rotations. `path_in_world` has one place per frame; only those in
/// `frames` count, and only these frames change. Accurate to single precision. Costs one
/// adaptation per frame.
/// Errors: those of retarget::make_character() and retarget::Adapter::make().
/// Precondition: the body has the bone; the range is within the motion.
[[nodiscard]] Result<BodyReach> reach_with_body(
    HumanBone bone,
    const std::vector<glm::dvec3>& path_in_world,
    const FrameRange& frames,
    EditState& state);

}  // namespace marey::edit
