// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "retarget/body/body_map.h"

namespace marey::retarget {

/// Angle between sole and floor beyond which no heel is raised. [rad]
inline constexpr double kMaxHeelPitch_rad = 0.96;

/// Returns the point about which the heel rises, from the ankle, in the T-pose: the toe
/// joint; for a foot without toes the front end of its sole, since nothing bends there.
[[nodiscard]] glm::dvec3 heel_pivot_in_t_pose(const FootMap& foot);

/// A foot whose heel may rise.
struct HeelLever {
  glm::dvec3 ankle_from_pivot{0.0};  ///< World axes. [m]
  glm::dvec3 axis{1.0, 0.0, 0.0};    ///< Unit, horizontal; positive turns raise the heel.
  double max_rad = 0.0;              ///< Largest turn. 0: the heel stays.
};

/// Returns the lever of a foot. `ankle_from_pivot` is that of the foot's place, in world
/// axes; `share` (0 to 1) scales the largest turn. The sole's angle with the floor stays
/// at most kMaxHeelPitch_rad; a foot that is steeper already does not rise further.
[[nodiscard]] HeelLever heel_lever(const FootMap& foot,
                                   const glm::dvec3& ankle_from_pivot,
                                   double share);

/// Returns the turn about the lever's axis that brings the ankle to `reach_m` from the
/// hip: 0 if it is no further already, at most max_rad, and never beyond the turn that
/// brings it nearest. Closed form.
[[nodiscard]] double heel_rise_rad(const HeelLever& lever,
                                   const glm::dvec3& hip_from_pivot,
                                   double reach_m);

}  // namespace marey::retarget
