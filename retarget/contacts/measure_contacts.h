// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/frame_range.h"
#include "core/base/ids.h"
#include "core/human/contacts.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"

namespace marey::retarget {

// Measures of contact quality on another body, relative to the movement of the source's
// feet and not to detected contacts. The same measure was applied to the rotation-copy
// baseline. docs/accuracy/README.md has figures.

/// Contact points: left ankle, right ankle, left toe joint, right toe joint.
inline constexpr int kContactPoints = 4;
inline constexpr std::array<HumanBone, kContactPoints> kContactBones{
    HumanBone::kLeftFoot,
    HumanBone::kRightFoot,
    HumanBone::kLeftToes,
    HumanBone::kRightToes};

/// World positions of the contact points, frame by frame; empty for missing toes.
using ContactPaths = std::array<std::vector<glm::dvec3>, kContactPoints>;
/// Returns the paths of the contact points.
/// Precondition: `map` was made from the motion's skeleton.
[[nodiscard]] ContactPaths contact_paths(const Motion& motion, const BodyMap& map);

/// Marks the frames in which each point touches the floor, as for the rotation-copy
/// baseline: slower than 20 cm/s to the next frame, and lower than 5 cm above the 2nd
/// percentile of its own heights. The last frame has no next one and is never marked. The
/// labels of the *source* are used for every body.
/// Precondition: `hz` > 0.
using ContactLabels = std::array<std::vector<char>, kContactPoints>;
[[nodiscard]] ContactLabels label_contacts(const ContactPaths& source, double hz);

/// One contact of one point.
struct ContactDrift {
  int point = 0;  ///< Index as in kContactBones.
  FrameRange frames;
  double drift_mm = 0.0;  ///< Maximum horizontal distance from its start.
};

struct ContactFigures {
  double mean_slide_cm_per_s = 0.0;  ///< Horizontal, over labelled points and frames.
  double worst_drift_mm = 0.0;       ///< Maximum horizontal drift within one contact.
  double median_drift_mm = 0.0;
  double sinking_mm = 0.0;  ///< Maximum depth of a point below its resting height.
  /// Maximum height of a foot's lowest point (ankle or toe joint, relative to their
  /// resting heights) while one of them is labelled.
  double float_mm = 0.0;
  int floating_frames = 0;           ///< Number of frames in which it is above 5 mm.
  std::vector<ContactDrift> drifts;  ///< All contacts, point by point, in time order.
};
/// Computes the measures. `rest_heights_m` are the heights of the points when the body
/// stands. Linear in frames.
/// Precondition: a label per frame of each point that has both; `hz` > 0.
[[nodiscard]] ContactFigures measure_contacts(
    const ContactPaths& paths,
    const ContactLabels& labels,
    const std::array<double, kContactPoints>& rest_heights_m,
    double hz);

/// Returns the heights of the contact points when the body stands. [m]
[[nodiscard]] std::array<double, kContactPoints> rest_heights_m(const BodyMap& map);

/// Returns the height of the head joint above the floor at rest; the hips' without a
/// head. [m]
/// Precondition: `map` was made from `skeleton`.
[[nodiscard]] double head_height_m(const Skeleton& skeleton, const BodyMap& map);

/// Returns the mean of |d3p/dt3| over joints and frames; 0 for fewer than four frames.
/// [m/s^3]
[[nodiscard]] double mean_jerk(const Motion& motion, std::span<const JointIndex> joints);
/// Returns the same over all joints.
[[nodiscard]] double mean_jerk(const Motion& motion);

}  // namespace marey::retarget
