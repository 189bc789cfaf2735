// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "app/stage/figures/clip_on_body.h"
#include "app/stage/figures/figure_body.h"
#include "app/stage/figures/foot_figures.h"
#include "app/stage/figures/worst_value.h"

namespace marey::app {

/// Returns the steps of both feet, left and right. A foot that stands has the part that
/// its rotation shows: the whole foot within 1 % of the leg length.
[[nodiscard]] std::array<std::vector<FootStep>, 2> foot_steps(const FigureBody& body,
                                                              const FigureSpan& span);

/// Returns the largest horizontal distance of the centre of mass, with loads, from its
/// vertical: that of the centre of mass without loads in the posture before constraints
/// and balance, carried along by the middle of both ankles. [mm] Linear.
/// Precondition: references are kept; the masses' sum is above 0.
[[nodiscard]] WorstValue com_error_mm(const FigureBody& body, const FigureSpan& span);

/// Returns the mean displacement of the hips backwards, against their heading, relative
/// to the middle of both ankles and to the posture before constraints and balance. [mm]
/// Precondition: references are kept.
[[nodiscard]] WorstValue pelvis_back_mm(const FigureBody& body, const FigureSpan& span);

/// Returns the horizontal distance of the hips from a target at an instant. [m]
[[nodiscard]] double hips_distance_m(const FigureBody& body,
                                     std::span<const glm::dvec3> targets_in_world,
                                     double time_s);

/// Returns the mean jerk of the marked joints. [m/s^3] nullopt: fewer than four steps.
[[nodiscard]] std::optional<double> body_jerk_m_s3(const FigureBody& body,
                                                   const FigureSpan& span,
                                                   double step_s);

/// A clip and the time that it plays.
struct PlayedClip {
  const MotionClip* clip = nullptr;
  double played_s = 0.0;
};
/// Returns the jerk of a body divided by that of the clips that it plays, each weighted
/// by its time; nullopt: either is unknown or zero.
[[nodiscard]] std::optional<double> jerk_ratio(const FigureBody& body,
                                               std::span<const PlayedClip> clips,
                                               const PostureLayout& layout,
                                               const FigureSpan& span,
                                               double step_s);

/// Returns the deviation of the spectrum of the lateral lean from that of a clip [%],
/// over all pieces of at least 4 s in which the hips move faster than 0.3 m/s. The clip
/// is measured in pieces of the same durations, from 8 places of its cycle each. nullopt:
/// no such piece; the clip does not lean.
[[nodiscard]] std::optional<double> sway_deviation_percent(const FigureBody& body,
                                                           const MotionClip& clip,
                                                           const PostureLayout& layout,
                                                           const FigureSpan& span,
                                                           double step_s);

}  // namespace marey::app
