// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/body.h"
#include "core/transform.h"

namespace marey::calib {

/// A person to plan with: average proportions, tags where they are usually worn.
struct PlannedBody {
  double stature_m = 0.0;
  Proportions proportions;
  std::vector<PlacedTag> tags;
};

/// The 29 tags of docs/formats.md: three on hips, upper chest and head, two on every limb
/// bone, one on each hand and foot. Ids from 0. Precondition: size_m > 0.
[[nodiscard]] std::vector<TagOnSegment> usual_tags(double size_m);

/// Glues tags to an average body, 15 mm off its skin: the first of a segment where it is
/// seen best, the next ones where the first is not. Tags on segments that carry none
/// usually (spine, chest, neck, collar bones, toes) are left out, and so are a fifth tag
/// and more on one segment. Precondition: stature_m > 0, sizes > 0.
[[nodiscard]] PlannedBody dress_body(double stature_m,
                                     std::span<const TagOnSegment> tags);

/// Where all bones are: world_from_bone by HumanBone.
using BodyPlace = std::array<RigidTransform, kHumanBoneCount>;

/// Standing upright with the arms 20 degrees off the body, the hips above `floor_m` (x, z
/// of the world), facing `heading_rad`, 0 being +Z, towards +X.
[[nodiscard]] BodyPlace standing_body(const PlannedBody& body,
                                      const glm::dvec2& floor_m,
                                      double heading_rad);

/// Walking there, in the step's phase `phase_rad` (a full turn is two steps).
[[nodiscard]] BodyPlace walking_body(const PlannedBody& body,
                                     const glm::dvec2& floor_m,
                                     double heading_rad,
                                     double phase_rad);

/// Moving every joint through most of its range while turning once around, `share` of the
/// way through (0 to 1).
[[nodiscard]] BodyPlace exercising_body(const PlannedBody& body,
                                        const glm::dvec2& floor_m,
                                        double share);

/// A part of the body that a camera cannot look through: all that is within `radius_m` of
/// the line between two points of the world.
struct Capsule {
  glm::dvec3 from_in_world{0.0};
  glm::dvec3 to_in_world{0.0};
  double radius_m = 0.0;
};

/// The whole body, in thicknesses of a lean adult.
[[nodiscard]] std::vector<Capsule> flesh_of(const PlannedBody& body,
                                            const BodyPlace& place);

/// Whether the straight line between two points passes any of them. Linear.
[[nodiscard]] bool is_hidden(const glm::dvec3& p_in_world,
                             const glm::dvec3& eye_in_world,
                             std::span<const Capsule> flesh);

}  // namespace marey::calib
