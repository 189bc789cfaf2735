// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include <glm/vec3.hpp>

#include "core/humanoid.h"

namespace marey::reconstruct {

/// An anatomical place on the body with a name, and the centre of a marker on it: some 8
/// mm above the skin.
struct Landmark {
  /// "left_asis", "c7"; for a place somewhere on a segment "left_thigh".
  std::string_view name;
  HumanBone segment;  ///< The bone that its skin moves with.
  /// On an average adult, in the bone's frame: its origin in the joint at the near end,
  /// axes parallel to the world's in the T-pose. In shares of stature.
  glm::dvec3 p_in_segment_per_stature;
  /// Standard deviation of places between people, layouts and placements, per coordinate.
  double sigma_per_stature;
};

/// From this sigma on, a landmark determines the segment, but hardly the place: markers
/// of clusters, and markers put off the bones to distinguish left from right.
inline constexpr double kSomewhereSigma = 0.03;

/// Returns every landmark: the left ones from head to foot, the right ones, mirror images
/// in the same order, then those of the middle. Names differ.
/// Places near a joint are relative to that joint in average_proportions(); widths and
/// distances on one segment are therefore exact, and heights above the floor as accurate
/// as those proportions. Sources: hip joint centres from the spines of the pelvis by
/// Harrington et al. (2007); trunk and limb lengths by de Leva (1996, tables 3 and 4) and
/// Winter (2009, fig. 4.1); breadths of pelvis, knee, ankle, elbow, wrist, hand and head
/// from the ANSUR survey (Gordon et al. 1989); definitions of the places by van Sint Jan
/// (2007). Corrected by the common deviations in static trials of six laboratories, and
/// by the markers of the OpenSim models of Rajagopal (2016), Hamner (2010) and Lai
/// (2017).
[[nodiscard]] std::span<const Landmark> landmarks();

/// Returns the landmark of this name; nullptr if there is none. Valid as long as the
/// program runs.
[[nodiscard]] const Landmark* find_landmark(std::string_view name);

/// Returns the landmark that is somewhere on this bone: "left_thigh" for kLeftUpperLeg.
[[nodiscard]] const Landmark& somewhere_on(HumanBone bone);

}  // namespace marey::reconstruct
