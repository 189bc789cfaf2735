// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "retarget/body/anthropometry.h"

namespace marey::retarget {

/// Place of a segment, in any axes.
struct SegmentAxes {
  glm::dvec3 along_m{0.0};  ///< From the proximal to the distal end point.
  /// Direction of the transverse axis. Its part along the segment is removed.
  glm::dvec3 transverse{1.0, 0.0, 0.0};
};

/// Returns the inertia of a segment about its centre of mass, per kilogram, in the axes
/// of `axes`. [m^2] Zero for a segment without a length.
[[nodiscard]] glm::dmat3 inertia_per_kg(const GyrationRadii& radii,
                                        const SegmentAxes& axes);

/// Part of a segment that consists of several.
struct SegmentPart {
  double mass_share = 0.0;      ///< They sum to 1.
  glm::dvec3 from_centre_m{0};  ///< From the segment's centre of mass to the part's.
};

/// Returns the inertia per kilogram that each part has about its own centre of mass, so
/// that the parts together have that of the segment: the segment's minus the parallel
/// axis terms. [m^2] Where the parts are too far apart for that, the nearest inertia that
/// a body can have.
[[nodiscard]] glm::dmat3 part_inertia_per_kg(const glm::dmat3& segment_inertia_per_kg_m2,
                                             std::span<const SegmentPart> parts);

}  // namespace marey::retarget
