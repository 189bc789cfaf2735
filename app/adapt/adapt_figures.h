// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/adapt/adapt_arguments.h"
#include "app/adapt/adapt_departure.h"
#include "app/adapt/adapt_posture.h"
#include "core/base/result.h"
#include "core/constraint.h"
#include "core/floor.h"
#include "retarget/adapt/adapt_motion.h"
#include "retarget/adapt/support_slide.h"

namespace marey::app {

/// All that is told of one run of `marey adapt`.
struct AdaptRun {
  std::string character;
  std::optional<Error> source_error;  ///< exchanged_sides_error() of the motion.
  ConstraintSet constraints;  ///< As they were asked of the adapter.
  retarget::AdaptedMotion adapted;
  double floor_height_m = 0.0;
  Floor floor;  ///< Heights from floor_height_m.
  /// Frames in which no height of the hips lets all standing legs reach that floor.
  int out_of_reach_frames = 0;
  std::vector<std::vector<retarget::SupportSlide>> slides;  ///< As adapted.supports.
  AdaptDeparture departure;  ///< From the motion on the character's body.
  AdaptPosture posture;
  /// Of constraints that ran out of few iterations: the default number meets them in
  /// their worst frame. One per constraint.
  std::vector<char> more_iterations_help;
  double adapt_s = 0.0;      ///< Wall clock, of the postures alone.
};

/// The report (docs/formats/README.md, "What marey adapt writes").
[[nodiscard]] nlohmann::ordered_json adapt_figures(const AdaptArguments& args,
                                                   const AdaptRun& run);

/// One line a person reads first.
[[nodiscard]] std::string adapt_summary(const AdaptArguments& args, const AdaptRun& run);

/// What the result fails by, if anything: a support that is off its footprint by more
/// than 1 mm; by priority, a constraint that was missed in more than half of the frames
/// in which it is fully active (a blend is a compromise, and promises nothing).
[[nodiscard]] const retarget::KeptConstraint* find_failure(const AdaptArguments& args,
                                                           const AdaptRun& run);

/// The same as an error (kQuality), or done; and a trunk that balance turns further from
/// its source than kMaxTrunk_deg although the constraints are met without; a motion
/// whose left and right are exchanged; posture_problem().
[[nodiscard]] Status check_adapted(const AdaptArguments& args, const AdaptRun& run);

/// What else was not kept, each with when, by how much and what would help; and
/// constraints that never were active; a floor that legs do not reach; balance that is
/// off by more than 10 mm; joints that are thrown about by more than 100 m/s2; a trunk
/// that is further from its source than kFarTrunk_deg.
[[nodiscard]] std::vector<std::string> adapt_warnings(const AdaptArguments& args,
                                                      const AdaptRun& run);

}  // namespace marey::app
