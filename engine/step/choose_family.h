// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/clips/motion_base.h"
#include <glm/vec3.hpp>

#include "core/base/result.h"
#include "core/skeleton.h"
#include "retarget/body/body_map.h"

namespace marey::engine {

/// A captured reach of a family, as it is played.
struct FamilyAction {
  std::size_t clip = 0;
  double weight = 1.0;   ///< The sum over the family is 1.
  double rate = 1.0;     ///< So that all arrive together.
  double event_s = 0.0;  ///< Arrival, in the clip.
};

/// Maximum number of captured reaches that are blended: one action remains for a walk.
inline constexpr std::size_t kMaxFamilyActions = 3;

/// Chooses the captured reaches of a family for a target and weighs them (ReachFamily),
/// by the places of the palm at their arrivals on this body. Greatest weight first.
/// `target_in_heading_m`: from the hips' place on the floor, in their heading frame.
/// Errors (bad input, naming the clip): unknown; a loop; without the event `arrive`.
[[nodiscard]] Result<std::vector<FamilyAction>> choose_family(
    const MotionBase& base,
    std::span<const std::string> clips,
    const std::string& arrive,
    int side,
    const glm::dvec3& target_in_heading_m,
    const Skeleton& skeleton,
    const retarget::BodyMap& map);

}  // namespace marey::engine
