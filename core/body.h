// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/humanoid.h"
#include "core/ids.h"
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
  double sigma_m = 0.0;    ///< Of the tag's centre, per coordinate.
  double sigma_rad = 0.0;  ///< Of its rotation, per axis.
  int sightings = 0;       ///< Frames times cameras that support it.
};

/// A marker glued to a segment of the body, or to the skin over it.
struct PlacedMarker {
  std::string label;
  HumanBone segment{};
  glm::dvec3 p_in_segment{0.0};  ///< [m]
  double sigma_m = 0.0;          ///< Of that place, per coordinate.
  double stray_m = 0.0;  ///< How far it strays from there with skin and noise, likewise.
  int frames = 0;        ///< Of the fit, in which it was seen.
};

/// One person: lengths, joint centres and where tags and markers sit, each with its doubt.
struct Body {
  std::string name;
  double stature_m = 0.0;
  std::optional<double> mass_kg;
  Proportions proportions;
  /// Standard deviation of each bone's origin in its parent's frame, per coordinate. [m]
  std::array<double, kHumanBoneCount> joint_centre_sigma_m{};
  std::vector<PlacedTag> tags;
  std::vector<PlacedMarker> markers;  ///< Labels all different.
};

}  // namespace marey
