// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: priors of postures, and functions that add the terms of
// posture_residuals.h to a Ceres problem.

#include <ceres/ceres.h>

#include "core/base/time.h"
#include "reconstruct/clusters/sightings.h"
#include "reconstruct/posture/pose_parameter_priors.h"
#include "reconstruct/posture/posture_residuals.h"

namespace marey::reconstruct {

/// Returns the bone's blocks in `posture`, in parameters_of() order.
[[nodiscard]] std::vector<double*> blocks_of(Posture& posture, HumanBone bone);

/// Adds anatomical limits and pose priors: a spine bends evenly; collar bones, hands and
/// feet do not turn far; elbows and knees do not bend backward. They are wide compared
/// with measurements and matter only for unseen parameters. `collar_bone_factor`
/// multiplies the sigmas of the collar bones' rotation about their vertical and forward
/// axes.
/// Priors of usual behaviour, unlike anatomical ones, have `prior_share` of their weight:
/// the instants of one trial repeat the same information.
void add_posture_priors(Posture& posture,
                        const Lengths& lengths,
                        ceres::Problem& problem,
                        const TwistPriors& twists = {},
                        double collar_bone_factor = 1.0,
                        double prior_share = 1.0);

/// Adds the smoothness of movement: the speed of every block is an Ornstein-Uhlenbeck
/// process (white-noise acceleration, and a time constant of a quarter of a second for
/// rotations, a second for translations). Three consecutive frames; the sigmas follow the
/// frame rate.
void add_smoothness(Posture& before,
                    Posture& now,
                    Posture& after,
                    FrameRate rate,
                    ceres::Problem& problem);

/// Adds the prior of the speeds at the start of a trial: the stationary distribution of
/// the process.
void add_first_speed(Posture& first,
                     Posture& second,
                     FrameRate rate,
                     ceres::Problem& problem);

/// Adds a prior that keeps every block of the posture near that of `expected`: within
/// `rad` for rotations and angles, `metres` for the hips.
void add_motion_prior(const Posture& expected,
                      double rad,
                      double metres,
                      Posture& posture,
                      ceres::Problem& problem);

/// Declares the posture's rotations to Ceres. Call once its blocks are in use.
void set_manifolds(Posture& posture, ceres::Problem& problem);

/// Makes the blocks of the posture constant in the problem. Blocks that the problem does
/// not use are skipped.
void set_posture_constant(Posture& posture, ceres::Problem& problem);

/// Returns options that give the same bytes on every run: one thread, no clock.
[[nodiscard]] ceres::Solver::Options solver_options(int max_iterations);

/// Returns the final cost of a solve, for comparisons: infinity if it failed.
[[nodiscard]] double cost_of(const ceres::Solver::Summary& summary);

}  // namespace marey::reconstruct
