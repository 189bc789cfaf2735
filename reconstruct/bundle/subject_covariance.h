// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: covariance of a fitted subject's unknowns and of its joint
// centres.

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "reconstruct/bundle/subject_bundle.h"
#include "reconstruct/bundle/subject_equations.h"

namespace marey::reconstruct {

/// Covariance of the subject's unknowns (SubjectColumns) from a bundle's equations, and
/// the solutions from single parts of the trials.
struct SubjectCovariance {
  Eigen::MatrixXd covariance;
  /// Solutions from each part's equations alone, one column per part.
  Eigen::MatrixXd part_solutions;

  /// Returns the covariance of a linear function of the unknowns: the model's, or the
  /// scatter of the parts if its trace is clearly larger (White 1982: under an inexact
  /// model residuals are correlated, and the model's covariance is too small).
  [[nodiscard]] Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& jacobian) const;
};

/// Computes the covariance from the normal matrix, one gradient per part of the trials,
/// and gradients of unit variance that all parts have in common. nullopt if the matrix is
/// not positive definite or the covariance is not finite.
[[nodiscard]] std::optional<SubjectCovariance> subject_covariance(
    const Eigen::MatrixXd& normal,
    const Eigen::MatrixXd& gradients,
    const Eigen::MatrixXd& common);

/// Returns the subject's gradients, one per column, for movements of the limbs' roots in
/// their trunk's frame in proportion to the limb's turn from its middle attitude, by one
/// standard deviation each: shoulders leave the sphere about their clavicle's inner end
/// as the scapula turns on it (Ludewig et al. 2009), and pelvis skin slides with all
/// turns of both thighs (slide_angles() includes their flexion). `frames` are the
/// bundle's, eliminated.
[[nodiscard]] Eigen::MatrixXd limb_root_gradients(
    const SubjectBundle& bundle,
    const SubjectColumns& columns,
    const std::vector<FrameEquations>& frames);

/// Fills bundle.centre_sigma_m: the effect of the errors of the subject's unknowns on
/// each joint centre in the world, with the frames' sightings unchanged and skin firm, as
/// solve_motion() assumes it; root mean square over frames of the moving trial that show
/// the joint's bone. `frames` are the bundle's, eliminated.
void fill_centre_sigmas(const SubjectCovariance& subject,
                        const SubjectColumns& columns,
                        const std::vector<FrameEquations>& frames,
                        SubjectBundle& bundle);

}  // namespace marey::reconstruct
