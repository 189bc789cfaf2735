// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/body.h"
#include "tests/support/simulation/simulated_body.h"
#include "tests/support/simulation/simulated_exercise.h"
#include "tests/support/simulation/simulated_soft_tissue.h"

namespace marey::testing {

/// A tag on the skin, and how its place moves on the segment.
struct GluedTag {
  TagOnSegment tag;
  RigidTransform segment_from_tag;  ///< In the reference posture.
  /// Slide over each angle that pulls at the skin. [m/rad]
  struct Pull {
    std::size_t angle = 0;
    glm::dvec3 slide_per_rad{0.0};
  };
  std::vector<Pull> pulls;
  double wobble_s2 = 0.0;  ///< Slide over acceleration. [m / (m/s^2)]
  /// The skin follows the bone's turn about itself (`lag_angle`) short of this share.
  double lag = 0.0;
  std::optional<std::size_t> lag_angle;
  glm::dvec3 lag_axis{0.0};
};

/// Number and size of a session's tags, and firmness of the skin under them.
struct TagStyle {
  int max_per_segment = 2;  ///< 1 to 3; at least one is on each needed segment.
  double size_m = 0.08;     ///< On trunk and thighs; less on smaller segments.
  double slide_m = 0.0;     ///< At most, on thighs: RMS over the range of motion.
};

/// Glues tags as a person would: on the sides of segments that can be seen, facing
/// outward, tilted by up to 15 degrees, any side up, ids shuffled. `range` are postures
/// of the range of motion: slides have their size over it. `reference` is the posture in
/// which no tag slides.
[[nodiscard]] std::vector<GluedTag> glue_tags(const SimulatedBody& body,
                                              std::span<const SoftTissuePart> soft_tissue,
                                              const TagStyle& style,
                                              std::span<const Attitude> range,
                                              const Attitude& reference,
                                              Dice& dice);

/// Returns the pose of the tag on its segment in a posture. `acceleration` is that of the
/// tag in the segment's frame. [m/s^2]
[[nodiscard]] RigidTransform segment_from_tag(const GluedTag& tag,
                                              const Attitude& attitude,
                                              const Attitude& reference,
                                              const glm::dvec3& acceleration);

}  // namespace marey::testing
