// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/time.h"
#include "retarget/body_map.h"
#include "retarget/detect_contacts.h"

namespace marey::retarget {

/// Where one foot is at one instant.
struct FootPlace {
  glm::dvec3 ankle_in_world{0.0};  ///< [m]
  /// T-pose-relative world rotations: a turn about Y is a foot flat on the floor.
  glm::dquat foot{1.0, 0.0, 0.0, 0.0};
  glm::dquat toes{1.0, 0.0, 0.0, 0.0};
};

struct FootPlanOptions {
  /// How long the speed of a contact's displacement takes to fade out after it, and in
  /// before it. Longer is softer, and follows noise further. [s]
  double blend_s = 0.28;
};

/// Moves a foot's path onto its footprints.
///
/// Every stance gets one footprint, the mean of where the reference foot stands flat in
/// it; of a foot that turns while it stands, one that turns with it about the point that
/// stays (retarget/footprint.h). While heel and ball bear, the foot is exactly flat and
/// on its footprint on the floor Y = 0, its ankle and toe joint at their own resting
/// heights; while only one bears, the foot turns about that joint as the reference does,
/// or, while a raised heel keeps still, not but with its footprint. Between stances the reference's path is
/// kept but for a displacement that joins the two stances' own with continuous position
/// and speed. The ankle and the toe joint are never lower than they rest.
///
/// `reference` holds the foot in the posture to keep, one entry per frame of `contacts`;
/// the answer is as long. Linear in frames.
[[nodiscard]] std::vector<FootPlace> plan_foot(std::span<const FootPlace> reference,
                                               const FootContacts& contacts,
                                               const FootMap& foot,
                                               double leg_length_m,
                                               FrameRate rate,
                                               const FootPlanOptions& options = {});

}  // namespace marey::retarget
