// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/base/ids.h"
#include "core/finding.h"
#include "core/humanoid.h"
#include "core/skeleton.h"
#include "core/transform.h"

namespace marey {

/// A tag glued to a segment of the body.
struct TagOnSegment {
  TagId id{};
  HumanBone segment{};
  double size_m = 0.0;  ///< Edge of the black square.
};

/// A tag whose place is known.
struct PlacedTag {
  TagOnSegment tag;
  RigidTransform segment_from_tag;
  double sigma_m = 0.0;    ///< Standard deviation of its centre, per coordinate.
  double sigma_rad = 0.0;  ///< Standard deviation of its rotation, per axis.
  int sightings = 0;       ///< Sum over the frames of the cameras that support it.
};

/// A marker glued to a segment of the body, or to the skin over it.
struct PlacedMarker {
  std::string label;
  HumanBone segment{};
  glm::dvec3 p_in_segment{0.0};  ///< [m]
  double sigma_m = 0.0;          ///< Standard deviation of that position, per coordinate.
  /// Standard deviation of its movement by skin and noise, per coordinate.
  double stray_m = 0.0;
  int frames = 0;  ///< Number of frames of the fit in which it was seen.
};

/// Deviation of an elbow or a knee from a straight hinge. Bent by an angle, the lower
/// bone is turned in the upper bone's frame by R(c, upper_rad) R(h, angle) R(c,
/// lower_rad), where h is HumanLimb::hinge_axis and c is +Z on the left, -Z on the right.
/// A straight limb deviates by the sum: the carrying angle of an elbow, the valgus of a
/// knee. The hinge's centre moves by rollback_m * (1 - cos angle) along -Z of the upper
/// bone (femoral rollback).
struct HingeShape {
  double upper_rad = 0.0;  ///< Angle of the hinge against the upper bone.
  double lower_rad = 0.0;  ///< Angle of the lower bone against the hinge.
  double rollback_m = 0.0;
};

/// One person: lengths, joint centres and places of tags and markers, each with its
/// uncertainty.
struct Body {
  std::string name;
  double stature_m = 0.0;
  std::optional<double> mass_kg;
  Proportions proportions;
  std::array<HingeShape, 4> hinges{};  ///< In the order of human_limbs().
  /// Standard deviation of each bone's origin in its parent's frame, per coordinate: 95 %
  /// of its errors are within 2.8 times that. [m]
  std::array<double, kHumanBoneCount> joint_centre_sigma_m{};
  std::vector<PlacedTag> tags;
  std::vector<PlacedMarker> markers;  ///< Labels all different.
  /// Reasons why a measured body may be wrong. Their severity is kFair; only cause and
  /// next are kept in files.
  std::vector<Finding> warnings;
};

}  // namespace marey
