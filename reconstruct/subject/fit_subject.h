// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/camera.h"
#include "core/detection.h"
#include "reconstruct/subject/subject_fit.h"

namespace marey::reconstruct {

/// Measures a person from a trial of standing still and one of moving every joint: joint
/// centres, segment lengths, and the place of each tag on its segment, all at once by one
/// bundle over chosen frames (reprojection of all tag corners in all cameras;
/// anthropometric and left/right priors as soft terms).
/// `standing` and `moving` hold one CameraDetections per camera of `cameras`, in order.
/// Sigmas come from the bundle's covariance, scaled by its residuals. A tag that faces
/// away from the others of its segment, or sits on a segment that the bundle does not
/// need (neck, collar bones, spine), is placed on the body found from the other tags,
/// then refined with it. Errors (kBadInput; `where` is empty or [[tags.tag]]): segments
/// without a usable tag; tags declared on segments that they do not move with
/// (find_suspect_tags.h); too few frames that show the hips, standing or moving; limbs
/// whose lengths are absurd for the declared stature (a wrong tag or board size). Cost:
/// some seconds; memory independent of the trials' lengths, apart from the detections.
[[nodiscard]] Result<SubjectFit> fit_subject(const SubjectPrior& prior,
                                             std::span<const Camera> cameras,
                                             std::span<const CameraDetections> standing,
                                             std::span<const CameraDetections> moving,
                                             const Progress& progress = {});

}  // namespace marey::reconstruct
