// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include <glm/vec3.hpp>

#include "core/motion.h"
#include "retarget/body_map.h"

namespace marey {

/// Left ankle, right ankle, left toe joint, right toe joint: what touches the floor.
inline constexpr int kContactPoints = 4;

/// World places of the contact points, frame by frame; empty for toes that are not there.
using ContactPaths = std::array<std::vector<glm::dvec3>, kContactPoints>;
[[nodiscard]] ContactPaths contact_paths(const Motion& motion,
                                         const retarget::BodyMap& map);

/// In which frames each point touches, as the rotation-copy baseline was labelled: slower
/// than 20 cm/s to the next frame, and lower than 5 cm above the 2nd percentile of its
/// own heights. Labels of the *source* are those of every body.
using ContactLabels = std::array<std::vector<char>, kContactPoints>;
[[nodiscard]] ContactLabels label_contacts(const ContactPaths& source, double hz);

struct ContactFigures {
  double mean_slide_cm_per_s = 0.0;  ///< Horizontal, over labelled points and frames.
  double worst_drift_mm = 0.0;  ///< Within one contact, from where it began; horizontal.
  double median_drift_mm = 0.0;
  double sinking_mm = 0.0;  ///< Deepest that a point is below where it rests.
  /// Highest that a foot's lowest point (ankle or toe joint, above where each rests) is
  /// while one of them is labelled.
  double float_mm = 0.0;
  int floating_frames = 0;  ///< In which that is more than 5 mm.
};
/// `rest_heights_m` are those of the points when the body stands.
[[nodiscard]] ContactFigures measure_contacts(
    const ContactPaths& paths,
    const ContactLabels& labels,
    const std::array<double, kContactPoints>& rest_heights_m,
    double hz);

/// Mean of |d3p/dt3| over joints and frames. [m/s^3]
[[nodiscard]] double mean_jerk(const Motion& motion);

}  // namespace marey
