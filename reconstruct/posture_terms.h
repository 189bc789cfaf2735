// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: what is known of postures before anybody looks, and how the
// terms of posture_residuals.h are put into a Ceres problem.

#include <ceres/ceres.h>

#include "core/time.h"
#include "reconstruct/posture_habits.h"
#include "reconstruct/posture_residuals.h"
#include "reconstruct/sightings.h"

namespace marey::reconstruct {

/// The bone's blocks in `posture`, in slots_of() order.
[[nodiscard]] std::vector<double*> blocks_of(Posture& posture, HumanBone bone);

/// Human limits and habits: a spine bends evenly, collar bones, hands and feet do not
/// turn far, elbows and knees do not bend backward. Wide next to any measurement; they
/// decide only what no camera sees.
/// `shoulders_wider` is by how much more than usual collar bones may be from lying level
/// and sideways. What people do, unlike how they are built, counts with `habit_share` of
/// its weight: over many instants of one trial it says the same again.
void add_habits(Posture& posture,
                const Lengths& lengths,
                ceres::Problem& problem,
                const TwistHabits& twists = {},
                double shoulders_wider = 1.0,
                double habit_share = 1.0);

/// A person standing still and upright, feet flat, hands in line with the forearms: what
/// gives a static trial's bones their directions.
void add_standing(Posture& posture, const Lengths& lengths, ceres::Problem& problem);

/// Bodies do not jerk, and do not go on for ever: the speed of every block is an
/// Ornstein-Uhlenbeck process (white-noise acceleration, and a memory of a quarter of a
/// second for turning, a second for travelling). Three neighbouring frames; the sigmas
/// follow the frame rate.
void add_smoothness(Posture& before,
                    Posture& now,
                    Posture& after,
                    FrameRate rate,
                    ceres::Problem& problem);

/// The speeds at the start of a trial: those that the process has on average.
void add_first_speed(Posture& first,
                     Posture& second,
                     FrameRate rate,
                     ceres::Problem& problem);

/// Keeps every block of the posture near that of `expected`: within `rad` for rotations
/// and angles, `metres` for the hips.
void add_leash(const Posture& expected,
               double rad,
               double metres,
               Posture& posture,
               ceres::Problem& problem);

/// Tells Ceres which blocks of the posture are rotations. Call once its blocks are in
/// use.
void set_manifolds(Posture& posture, ceres::Problem& problem);

/// Keeps the posture as it is.
void hold(Posture& posture, ceres::Problem& problem);

/// Options that give the same bytes on every run: one thread, no clock.
[[nodiscard]] ceres::Solver::Options solver_options(int max_iterations);

/// What a solve ended with, for comparing it with others: infinity where it failed.
[[nodiscard]] double cost_of(const ceres::Solver::Summary& summary);

}  // namespace marey::reconstruct
