// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/ids.h"
#include "core/motion.h"
#include "retarget/body_map.h"
#include "retarget/detect_contacts.h"

namespace marey::retarget {

// How well feet keep to the floor on another body, measured against what the source's
// feet do and not against what was found in it: the measure that copied rotations were
// judged by, too. docs/measurements.md has figures.

/// Left ankle, right ankle, left toe joint, right toe joint: what touches the floor.
inline constexpr int kContactPoints = 4;
inline constexpr std::array<HumanBone, kContactPoints> kContactBones{
    HumanBone::kLeftFoot,
    HumanBone::kRightFoot,
    HumanBone::kLeftToes,
    HumanBone::kRightToes};

/// World places of the contact points, frame by frame; empty for toes that are not there.
using ContactPaths = std::array<std::vector<glm::dvec3>, kContactPoints>;
/// Precondition: `map` was made from the motion's skeleton.
[[nodiscard]] ContactPaths contact_paths(const Motion& motion, const BodyMap& map);

/// In which frames each point touches, as the rotation-copy baseline was labelled: slower
/// than 20 cm/s to the next frame, and lower than 5 cm above the 2nd percentile of its
/// own heights. Never the last frame, which has no next. Labels of the *source* are those
/// of every body. Precondition: `hz` > 0.
using ContactLabels = std::array<std::vector<char>, kContactPoints>;
[[nodiscard]] ContactLabels label_contacts(const ContactPaths& source, double hz);

/// One contact of one point.
struct ContactDrift {
  int point = 0;  ///< As kContactBones.
  FrameInterval frames;
  double drift_mm = 0.0;  ///< Furthest from where it began; horizontal.
};

struct ContactFigures {
  double mean_slide_cm_per_s = 0.0;  ///< Horizontal, over labelled points and frames.
  double worst_drift_mm = 0.0;  ///< Within one contact, from where it began; horizontal.
  double median_drift_mm = 0.0;
  double sinking_mm = 0.0;  ///< Deepest that a point is below where it rests.
  /// Highest that a foot's lowest point (ankle or toe joint, above where each rests) is
  /// while one of them is labelled.
  double float_mm = 0.0;
  int floating_frames = 0;           ///< In which that is more than 5 mm.
  std::vector<ContactDrift> drifts;  ///< Of every contact, point by point, in time.
};
/// `rest_heights_m` are those of the points when the body stands. Linear in frames.
/// Precondition: a label per frame of each point that has both; `hz` > 0.
[[nodiscard]] ContactFigures measure_contacts(
    const ContactPaths& paths,
    const ContactLabels& labels,
    const std::array<double, kContactPoints>& rest_heights_m,
    double hz);

/// The contact points' heights when the body stands. [m]
[[nodiscard]] std::array<double, kContactPoints> rest_heights_m(const BodyMap& map);

/// From the floor to the head joint of the body at rest; without a head to the hips. [m]
/// Precondition: `map` was made from `skeleton`.
[[nodiscard]] double head_height_m(const Skeleton& skeleton, const BodyMap& map);

/// Mean of |d3p/dt3| over joints and frames; 0 of fewer than four frames. [m/s^3]
[[nodiscard]] double mean_jerk(const Motion& motion, std::span<const JointIndex> joints);
/// Over all joints.
[[nodiscard]] double mean_jerk(const Motion& motion);

}  // namespace marey::retarget
