// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/humanoid.h"
#include "core/skeleton.h"
#include "recordings/turned_surface.h"

// The mannequin under construction: its parts are in mannequin_limbs.cpp and
// mannequin_trunk.cpp. Lengths there that are not named otherwise are parts of the body's
// size, which for an average adult is the stature; all are by eye, after anatomical
// drawings.

namespace marey::recordings {

/// The mesh's parts, by material.
enum FigurePart : std::size_t { kSkin, kJoint, kMark };

/// Height of the toe joints over the sole.
inline constexpr double kToeJointHeight = 0.012;

/// What the parts build on and add to.
struct Figure {
  MeshBuilder builder;
  Proportions proportions;
  std::array<glm::dvec3, kHumanBoneCount> p_in_world{};
  double size_m = 1.0;       ///< Of the whole body: along it. [m]
  double thickness_m = 1.0;  ///< Of the whole body: across it, size times girth. [m]

  [[nodiscard]] const glm::dvec3& at(HumanBone bone) const {
    return p_in_world[index(bone)];
  }
  void add_ball(HumanBone bone, double radius);
};

void add_arm(Figure& figure, const HumanLimb& arm);
void add_hand(Figure& figure, HumanBone hand, const glm::dvec3& tip_in_hand);
void add_leg(Figure& figure, const HumanLimb& leg);
void add_foot(Figure& figure,
              HumanBone foot,
              HumanBone toes,
              const glm::dvec3& tip_in_toes);
void add_trunk(Figure& figure);
void add_neck(Figure& figure);
void add_head(Figure& figure);

/// A cross-section at `at` along a path.
struct Section {
  double at;
  double half_width;
  double half_depth;
  double shift;  ///< Of the centre, towards the front.
};

/// Between `keys`, ascending in `at`: a cubic through them (Catmull-Rom).
[[nodiscard]] Section section_at(std::span<const Section> keys, double at);

/// `count` + 1 places from the first key's to the last's, closer together at the ends,
/// where the surface rounds off.
[[nodiscard]] std::vector<double> places_along(std::span<const Section> keys, int count);

/// 0 up to `from`, 1 beyond `to`, smooth (C1: enough for a shape) between; from > to runs
/// the other way.
[[nodiscard]] double ease(double from, double to, double x);

/// Unit `v`, or `otherwise` when v has no direction.
[[nodiscard]] glm::dvec3 direction(const glm::dvec3& v, const glm::dvec3& otherwise);

/// The unit vector nearest to `wanted` that is perpendicular to the unit `along`.
[[nodiscard]] glm::dvec3 unit_across(const glm::dvec3& wanted, const glm::dvec3& along);

}  // namespace marey::recordings
