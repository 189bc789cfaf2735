// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: sizes of skin slides and sigmas of a subject's bundle.

#include <span>

#include "core/camera.h"
#include "reconstruct/bundle/subject_bundle.h"

namespace marey::reconstruct {

/// Returns the factor by which covariances are too small: residuals may be larger than
/// expected, and many sightings of one tag by one camera are correlated. At least 1.
/// Before measure() from the number of sightings alone.
[[nodiscard]] double variance_scale(const SubjectBundle& bundle);

/// Frees the tags to slide with the adjacent joints: a slide in proportion to an angle
/// resembles a joint at another place, so residuals hardly show it. The size of slides is
/// estimated as the variance of random effects (restricted maximum likelihood; Patterson
/// & Thompson 1971), with the corners' noise from the fit; the weight of the priors also
/// treats sightings of one tag by one camera as dependent. Some 2 s. False if the
/// equations have no solution. Preconditions: adjust() has converged, then measure().
[[nodiscard]] bool refine_slides(SubjectBundle& bundle, std::span<const Camera> cameras);

/// Fills the sigmas of lengths, tags and joint centres. False if the equations have no
/// solution. Precondition: refine_slides().
[[nodiscard]] bool fill_sigmas(SubjectBundle& bundle, std::span<const Camera> cameras);

}  // namespace marey::reconstruct
