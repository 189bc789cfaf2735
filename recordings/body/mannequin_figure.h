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
#include "recordings/body/turned_surface.h"

// The mannequin under construction. Its parts are in mannequin_figure_limbs.cpp and
// mannequin_figure_trunk.cpp. Lengths there without a unit in their name are fractions of
// the body's size, which for an average adult is the stature; they are estimated by eye
// from anatomical drawings.

namespace marey::recordings {

/// The mesh's parts, by material.
enum FigurePart : std::size_t { kSkin, kJoint, kMark };

/// Height of the toe joints over the sole.
inline constexpr double kToeJointHeight = 0.012;

/// State shared by the functions that build the parts.
struct Figure {
  MeshBuilder builder;
  Proportions proportions;
  std::array<glm::dvec3, kHumanBoneCount> p_in_world{};
  double size_m = 1.0;       ///< Longitudinal scale of the body. [m]
  double thickness_m = 1.0;  ///< Transverse scale of the body: size times girth. [m]

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
  double shift;  ///< Offset of the centre towards the front.
};

/// Interpolates between `keys`, ascending in `at`, by a cubic through them (Catmull-Rom).
[[nodiscard]] Section section_at(std::span<const Section> keys, double at);

/// Returns `count` + 1 positions from the first key to the last, denser at the ends,
/// where the surface is rounded.
[[nodiscard]] std::vector<double> places_along(std::span<const Section> keys, int count);

/// Returns 0 up to `from`, 1 beyond `to`, and a smooth transition (C1) in between;
/// decreasing if from > to.
[[nodiscard]] double ease(double from, double to, double x);

/// Returns the unit vector of `v`, or `otherwise` if v has no direction.
[[nodiscard]] glm::dvec3 direction(const glm::dvec3& v, const glm::dvec3& otherwise);

/// Returns the unit vector nearest to `wanted` that is perpendicular to the unit vector
/// `along`.
[[nodiscard]] glm::dvec3 unit_across(const glm::dvec3& wanted, const glm::dvec3& along);

}  // namespace marey::recordings
