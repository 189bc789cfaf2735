// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: the joint refinement behind every calibration.

#include <optional>

#include "calib/bundle/refine_options.h"
#include "calib/model/rig_model.h"

namespace marey::calib {

/// Minimises the reprojection error of all sightings over cameras, targets and the
/// parameters that the options select. The first pass is robust (Cauchy loss at five
/// sigmas of a tag, three of a point). Then sightings with large errors, compared with
/// the others of their camera, are marked as outliers and excluded from a plain
/// least-squares refinement of the rest. Weak priors keep parameters that a recording
/// does not determine at their usual value (bundle_priors.h). Sightings without a known
/// pose, or behind their camera at the start, are marked as outliers from the beginning.
///
/// Returns nullopt if the solver finds no minimum, or one in which a camera is
/// unconstrained.
/// Single-threaded with a fixed order of summation: results are bit-identical.
[[nodiscard]] std::optional<RigUncertainty> refine_rig(RigModel& model,
                                                       const RefineOptions& options);

}  // namespace marey::calib
