// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: covariances of what a fitted subject's unknowns determine.

#include <vector>

#include <Eigen/Core>

#include "reconstruct/subject_bundle.h"
#include "reconstruct/subject_equations.h"

namespace marey::reconstruct {

/// What a bundle's equations determine of the subject's unknowns (SubjectColumns), and by
/// how much the answers of different parts of the trials differ.
struct Knowledge {
  Eigen::MatrixXd covariance;
  Eigen::MatrixXd moves;  ///< By each part's equations alone, one column per part.

  /// Returns the covariance of a linear function of the unknowns: the model's, or the
  /// scatter of the parts where its trace is clearly larger (White 1982: with a model
  /// that is not quite right residuals are correlated, and its covariance is too small).
  [[nodiscard]] Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& jacobian) const;
};

/// From the normal matrix, one gradient per part of the trials, and gradients of unit
/// variance that all parts have in common. The covariance is not finite where the matrix
/// is not positive definite.
[[nodiscard]] Knowledge knowledge_of(const Eigen::MatrixXd& normal,
                                     const Eigen::MatrixXd& gradients,
                                     const Eigen::MatrixXd& common);

/// Returns the subject's gradients, one per column, if the limbs' roots move in their
/// trunk's frame in proportion to the limb's turn from its middle attitude, by one
/// standard deviation each: shoulders leave the sphere about their clavicle's inner end
/// as the scapula turns on it (Ludewig et al. 2009), and pelvis skin slides with all
/// turns of both thighs (slide_angles() has their flexion). `frames` are the bundle's,
/// eliminated.
[[nodiscard]] Eigen::MatrixXd root_glides(const SubjectBundle& bundle,
                                          const SubjectColumns& columns,
                                          const std::vector<FrameEquations>& frames);

/// Fills bundle.centre_sigma_m: how far the errors of the subject's unknowns move each
/// joint centre in the world while the frames' sightings stay as they are and skin is
/// taken as firm, as solve_motion() takes it; root mean square over frames of the moving
/// trial that show the joint's bone. `frames` are the bundle's, eliminated.
void fill_centre_sigmas(const Knowledge& knowledge,
                        const SubjectColumns& columns,
                        const std::vector<FrameEquations>& frames,
                        SubjectBundle& bundle);

}  // namespace marey::reconstruct
