// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/body.h"
#include "core/camera.h"
#include "core/detection.h"
#include "core/pose.h"
#include "tests/support/simulation/synthetic_rig.h"

namespace marey::testing {

/// A person of 1.75 m, not an average one: legs 4 % longer, arms 4 % shorter, one shank
/// 3 mm longer than the other. Carries 29 tags, laid out as on the rendered recordings: 3
/// on hips, upper chest and head, 2 on every limb bone, 1 on hands and feet, 3 to 12 cm
/// off the bone, a few degrees askew, ids 40 to 68.
///
/// Quantities that no tag determines are average: the height of the hips' joint above the
/// hip centres, the start of the collar bones, toes and tips.
[[nodiscard]] Body tagged_person();

/// A posture for every time. [s]
using Movement = std::function<Pose(double time_s)>;

/// Standing still and upright, feet flat, arms down and 20 degrees off the body.
[[nodiscard]] Movement standing(const Body& body);

/// Every joint through most of its range, on one spot and turning there.
[[nodiscard]] Movement range_of_motion(const Body& body);

/// Walking along Z at 0.8 m/s, in the middle at 1 s, arms swinging.
[[nodiscard]] Movement walking(const Body& body);

struct Film {
  int frames = 60;
  double hz = 30.0;
  std::string trial = "walk";  ///< Prefix of the videos' names.
  Disturbance disturbance;
  std::vector<double> offsets_s;  ///< Per camera; empty: all zero. Not reported.
  /// Tags that something hides in a frame. May be empty.
  std::function<bool(const TagOnSegment& tag, int frame)> hidden;
};

/// Returns the cameras' detections of the body in motion. The body hides nothing.
[[nodiscard]] std::vector<CameraDetections> film(const Body& body,
                                                 const Movement& movement,
                                                 const std::vector<Camera>& cameras,
                                                 const Film& film);

/// Returns the tags without their places, as a session's file lists them.
[[nodiscard]] std::vector<TagOnSegment> tags_of(const Body& body);

/// The joints that tags on both sides pin down: hips, knees, ankles, shoulders, elbows
/// and wrists.
[[nodiscard]] const std::vector<HumanBone>& limb_joints();

}  // namespace marey::testing
