// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include <glm/vec3.hpp>

#include "core/humanoid.h"

namespace marey::reconstruct {

/// A place on the body that has a name in anatomy, and where the centre of a marker is
/// that somebody glued there: some 8 mm above the skin.
struct Landmark {
  /// "left_asis", "c7"; of a place somewhere on a segment "left_thigh".
  std::string_view name;
  HumanBone segment;  ///< The bone with which its skin moves.
  /// On an average adult, in the bone's frame: its origin in the joint at the near end,
  /// axes parallel to the world's in the T-pose. In shares of stature.
  glm::dvec3 p_in_segment_per_stature;
  /// Per coordinate: how far places differ between people, layouts and hands that glue.
  double sigma_per_stature;
};

/// From this sigma on a landmark says on which segment, and little of where: the markers
/// of clusters, and those that sets put off the bones to tell left from right.
inline constexpr double kSomewhereSigma = 0.03;

/// Every landmark: the left ones from head to foot, the right ones, mirror images in the
/// same order, then those of the middle. Names differ.
///
/// Places near a joint are given from that joint, as average_proportions() has it; so
/// widths and distances of one segment hold, and heights above the floor as far as those
/// proportions do. Sources: hip joint centres from the spines of the pelvis by Harrington
/// et al. (2007); trunk and limb lengths by de Leva (1996, tables 3 and 4) and Winter
/// (2009, fig. 4.1); breadths of pelvis, knee, ankle, elbow, wrist, hand and head from
/// the ANSUR survey (Gordon et al. 1989); definitions of the places by van Sint Jan
/// (2007). Corrected by what they had in common in static trials of six laboratories, and
/// by the markers of the OpenSim models of Rajagopal (2016), Hamner (2010) and Lai
/// (2017).
[[nodiscard]] std::span<const Landmark> landmarks();

/// The landmark of this name, nullptr when there is none. Lives as long as the program.
[[nodiscard]] const Landmark* find_landmark(std::string_view name);

/// The landmark that is somewhere on this bone: "left_thigh" of kLeftUpperLeg.
[[nodiscard]] const Landmark& somewhere_on(HumanBone bone);

}  // namespace marey::reconstruct
