// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "benchmarks/engine/transition_clips.h"
#include "core/motion.h"

namespace marey {

/// A switch from one clip to another that every method plays. Times of the clips.
struct SwitchCase {
  const TransitionClip* from = nullptr;
  const TransitionClip* to = nullptr;
  /// Time of `from` at the switch: a whole frame.
  double leave_s = 0.0;
  /// Requested time of `to` at the switch: a whole frame. A method that
  /// synchronises may enter elsewhere.
  double enter_s = 0.0;
};

/// Time before and after the switch that a method has to play. [s]
inline constexpr double kPlayedAround_s = 0.6;

/// Clips behind one frame of a result. Entry 0 is SwitchCase::from, 1 is `to`.
struct TransitionFrame {
  std::array<double, 2> source_s{};  ///< Time in each clip.
  /// Their share in the posture that is sampled, sum 1: an inertial method samples the
  /// second clip alone from the switch on. Labels are those of the heavier clip.
  std::array<double, 2> weight{};
  /// Share of the second clip in the shown posture where it is less than its weight: an
  /// inertial method has 1 minus the remaining share of its offset. nullopt: weight[1].
  std::optional<double> arrived{};
};

/// One switch as a method played it, on the body of the clips or another one.
struct TransitionResult {
  /// At 60 or 120 Hz; at least 0.5 s and two frames before and after the switch.
  Motion motion;
  double switch_s = 0.0;                ///< From the first pose: a whole frame.
  std::vector<TransitionFrame> frames;  ///< One per pose.
  /// Hips of the blend before supports and adaptation, one per pose; empty: they are the
  /// played ones.
  std::vector<glm::dvec3> blend_hips_in_world;
};

/// Largest values of both clips, to which those of a result are compared.
struct SourceFigures {
  double peak_acceleration_m_s2 = 0.0;
  double mean_jerk_m_s3 = 0.0;  ///< The larger one.
};

/// Horizontal speeds in the steps in which feet bear. [cm/s]
struct SlideSamples {
  std::vector<double> points;  ///< Every foot point that bears.
  /// The points that are also slower than 15 cm/s in the clip itself. This excludes the
  /// steps in which a foot rolls, lands or leaves.
  std::vector<double> still;
};

/// Figures of one switch.
struct TransitionFigures {
  /// In the 0.3 s after the switch. A point bears in the frame in which the step ends if
  /// the clip that weighs more there bears at its time there.
  SlideSamples slides;
  SlideSamples own;               ///< The same points and times in that clip itself.
  double slide_cm_s = 0.0;        ///< Mean of slides.points; 0 without any.
  double still_slide_cm_s = 0.0;  ///< Mean of slides.still.
  /// Largest acceleration of a joint or tip within 0.5 s of the switch over the sources'.
  double acceleration = 0.0;
  double acceleration_at_s = 0.0;  ///< Time of it from the switch.
  /// Place of it: a joint of the skeleton, or beyond those a tip.
  std::size_t acceleration_point = 0;
  /// Mean jerk of joints and tips within 0.5 s of the switch over the sources'.
  double jerk = 0.0;
  /// The same from the switch on for 0.3 s.
  double jerk_after = 0.0;
  /// Time from the switch until the second clip has 90 % of the weight; kPlayedAround_s
  /// if it does not. [s]
  double settled_s = 0.0;
  double hips_beyond_cm = 0.0;    ///< Largest distance of the hips from the blend's.
  double hips_beyond_at_s = 0.0;  ///< Time of it from the switch.
  /// Largest step of a point that bears and is still in the clip, its place among the
  /// foot points, and its time from the switch.
  double worst_slide_cm_s = 0.0;
  std::size_t worst_slide_point = 0;
  double worst_slide_at_s = 0.0;
  /// Largest distance from hip to ankle over the leg's length within 0.5 s of the switch.
  double leg_extension = 0.0;
};

/// Returns the figures of a whole clip at a rate: those of its own frames, every second
/// one at 60 Hz. Linear in frames times joints.
/// Precondition: the rate divides that of the clip.
[[nodiscard]] SourceFigures source_figures(const TransitionClip& clip, double hz);
/// Returns the larger ones of both clips.
[[nodiscard]] SourceFigures source_figures(const SwitchCase& played, double hz);

/// Returns the slide of a clip itself, over all of its frames.
[[nodiscard]] SlideSamples own_slides(const TransitionClip& clip);

/// Judges one switch by its own forward kinematics, labels and differences. `sources` are
/// those at the motion's rate.
/// Precondition: the result is as TransitionResult requires; its skeleton can be mapped,
/// and has toes if those of the clips have.
[[nodiscard]] TransitionFigures judge(const SwitchCase& played,
                                      const TransitionResult& result,
                                      const SourceFigures& sources);

/// Figures of all switches of a method.
struct MethodFigures {
  double slide_mean_cm_s = 0.0;  ///< Mean over all bearing steps of all switches.
  /// 95th percentile over switches of TransitionFigures::slide_cm_s.
  double slide_p95_cm_s = 0.0;
  double own_slide_mean_cm_s = 0.0;    ///< The clips' own.
  double still_slide_mean_cm_s = 0.0;  ///< The same of SlideSamples::still.
  double still_slide_p95_cm_s = 0.0;
  double own_still_slide_mean_cm_s = 0.0;
  double acceleration_median = 0.0;
  double acceleration_worst = 0.0;
  double jerk_mean = 0.0;
  double jerk_after_mean = 0.0;
  double settled_median_s = 0.0;
  double hips_beyond_worst_cm = 0.0;
  double leg_extension_worst = 0.0;
};

/// Precondition: not empty.
[[nodiscard]] MethodFigures summarize(const std::vector<TransitionFigures>& all);

/// Judges all switches of a method: as many results as cases, not none.
[[nodiscard]] MethodFigures judge_method(const std::vector<SwitchCase>& cases,
                                         const std::vector<TransitionResult>& results);

}  // namespace marey
