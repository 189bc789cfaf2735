// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/body.h"
#include "core/transform.h"

namespace marey::calib {

/// A subject for planning: average proportions, with tags at their usual places.
struct PlannedBody {
  double stature_m = 0.0;
  Proportions proportions;
  std::vector<PlacedTag> tags;
};

/// Returns the 29 tags of docs/formats/README.md: three on hips, upper chest and head,
/// two on every limb bone, one on each hand and foot. Ids from 0.
/// Precondition: size_m > 0.
[[nodiscard]] std::vector<TagOnSegment> typical_tags(double size_m);

/// Places tags on an average body, 15 mm off its skin: the first tag of a segment where
/// it is most visible, the next ones where the first is not visible. Tags on segments
/// that usually have none (spine, chest, neck, collar bones, toes) are omitted, and so
/// are more than four tags on one segment. Preconditions: stature_m > 0, sizes > 0.
[[nodiscard]] PlannedBody make_planned_body(double stature_m,
                                            std::span<const TagOnSegment> tags);

/// Poses of all bones: world_from_bone by HumanBone.
using BodyPlace = std::array<RigidTransform, kHumanBoneCount>;

/// Returns a body standing upright with the arms 20 degrees off the body, the hips above
/// `floor_m` (x, z of the world), facing `heading_rad`: 0 is +Z, positive towards +X.
[[nodiscard]] BodyPlace standing_body(const PlannedBody& body,
                                      const glm::dvec2& floor_m,
                                      double heading_rad);

/// Returns the walking body there, at the gait phase `phase_rad` (2 pi is two steps).
[[nodiscard]] BodyPlace walking_body(const PlannedBody& body,
                                     const glm::dvec2& floor_m,
                                     double heading_rad,
                                     double phase_rad);

/// Returns the body moving every joint through most of its range while turning once
/// around, at the fraction `share` of the motion (0 to 1).
[[nodiscard]] BodyPlace exercising_body(const PlannedBody& body,
                                        const glm::dvec2& floor_m,
                                        double share);

/// An opaque part of the body: all points within `radius_m` of the line between two
/// points of the world.
struct SoftTissueCapsule {
  glm::dvec3 from_in_world{0.0};
  glm::dvec3 to_in_world{0.0};
  double radius_m = 0.0;
};

/// Returns the whole body, with the thicknesses of a lean adult.
[[nodiscard]] std::vector<SoftTissueCapsule> soft_tissue_of(const PlannedBody& body,
                                                            const BodyPlace& place);

/// Returns true if the straight line between two points passes through a capsule. Linear.
[[nodiscard]] bool is_hidden(const glm::dvec3& p_in_world,
                             const glm::dvec3& eye_in_world,
                             std::span<const SoftTissueCapsule> soft_tissue);

}  // namespace marey::calib
