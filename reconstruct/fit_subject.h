// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/body.h"
#include "core/camera.h"
#include "core/detection.h"
#include "core/progress.h"
#include "core/result.h"

namespace marey::reconstruct {

/// What is known of a subject before anything is measured.
struct SubjectPrior {
  std::string name;
  double stature_m = 0.0;
  std::optional<double> mass_kg;
  std::vector<TagOnSegment> tags;
};

/// A hand or foot that the body does without: its tags fit in two ways, in no way, or
/// were never seen well enough to tell. Its joint is found from the other segments alone,
/// and no motion has it as measured.
struct LeftOutSegment {
  HumanBone segment{};
  Error reason;  ///< kQuality: the cause and the movement to record.
};

struct SubjectFit {
  Body body;
  double rms_px = 0.0;  ///< Reprojection of all tag corners used, inliers and not.
  /// Measured limb lengths over an average person's of the declared stature.
  double limb_ratio = 0.0;
  /// Tags that were never seen well enough to be placed; the body does without them.
  /// Those of `left_out` are not among them.
  std::vector<TagId> unplaced;
  /// In the order of human_limbs(). Each reason is also one of `doubts`; where `doubts`
  /// has no others, the rest of the body is trusted.
  std::vector<LeftOutSegment> left_out;
  /// Reasons not to trust the fit (kQuality), each with the segment and the next step:
  /// sightings that no place of a tag explains, hands and feet that fit in two ways,
  /// lengths that no person has. Empty when all sightings go together. In words also in
  /// body.doubts.
  std::vector<Error> doubts;
};

/// Measures a person from a trial of standing still and one of moving every joint: joint
/// centres, segment lengths, and where each tag sits on its segment, all at once by one
/// bundle over chosen frames (reprojection of all tag corners in all cameras;
/// anthropometric and left/right priors as soft terms).
///
/// `standing` and `moving` hold one CameraDetections per camera of `cameras`, in order.
/// Sigmas come from the bundle's covariance, scaled by its residuals.
/// A tag that faces away from the others of its segment, or sits on a segment that the
/// bundle does not need (neck, collar bones, spine), is placed on the body that the
/// others found, then refined with it. Errors (kBadInput; `where` is empty or
/// [[tags.tag]]): segments without a usable tag; tags declared on segments that they do
/// not move with (check_worn.h); too few frames that show the hips, standing or moving;
/// limbs whose lengths are absurd for the declared stature (a wrong tag or board size).
/// Cost: some seconds; memory independent of the trials' lengths beyond the detections.
[[nodiscard]] Result<SubjectFit> fit_subject(const SubjectPrior& prior,
                                             std::span<const Camera> cameras,
                                             std::span<const CameraDetections> standing,
                                             std::span<const CameraDetections> moving,
                                             const Progress& progress = {});

}  // namespace marey::reconstruct
