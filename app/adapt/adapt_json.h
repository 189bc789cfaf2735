// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/balance/support_polygon.h"
#include <nlohmann/json_fwd.hpp>

#include "app/adapt/adapt_arguments.h"
#include "app/adapt/adapt_departure.h"
#include "app/adapt/adapt_posture.h"
#include "core/base/result.h"
#include "core/constraint.h"
#include "core/finding.h"
#include "core/floor.h"
#include "retarget/adapt/adapt_motion.h"
#include "retarget/adapt/support_slide.h"

namespace marey::app {

/// Input and results of one run of `marey adapt`.
struct AdaptRun {
  std::string character;
  /// assess_exchanged_sides() of the motion.
  std::optional<Finding> source_finding;
  ConstraintSet constraints;  ///< As passed to the adapter.
  retarget::AdaptedMotion adapted;
  double floor_height_m = 0.0;
  Floor floor;  ///< Heights are relative to floor_height_m.
  /// Number of frames in which no hip height lets all standing legs reach that floor.
  int out_of_reach_frames = 0;
  std::vector<std::vector<retarget::SupportSlide>> slides;  ///< Like adapted.supports.
  AdaptDeparture departure;  ///< Relative to the motion on the character's body.
  AdaptPosture posture;
  std::optional<dynamics::ZmpFigures> zmp;  ///< With `--balance zmp`.
  /// Per constraint: it reached a low iteration limit, and the default limit meets it in
  /// its worst frame.
  std::vector<char> more_iterations_help;
  double adapt_s = 0.0;  ///< Wall-clock time of the adaptation alone.
};

/// Returns the report (docs/formats/adapt.md).
[[nodiscard]] nlohmann::ordered_json adapt_json(const AdaptArguments& args,
                                                const AdaptRun& run);

/// Returns a summary of one line.
[[nodiscard]] std::string adapt_summary(const AdaptArguments& args, const AdaptRun& run);

/// Returns the first failure, or null: a support that is more than 1 mm off its
/// footprint; with priority control, a constraint missed in more than half of the frames
/// in which it is fully active. With blend control, constraints are a compromise and
/// cannot fail.
[[nodiscard]] const retarget::KeptConstraint* find_failure(const AdaptArguments& args,
                                                           const AdaptRun& run);

/// Returns a poor finding for find_failure(), for a trunk that balance turns further
/// from its source than kMaxTrunk_deg although the constraints are met without balance,
/// for a motion whose left and right are exchanged, and for assess_posture().
[[nodiscard]] std::optional<Finding> assess_failure(const AdaptArguments& args,
                                                    const AdaptRun& run);

/// Returns fair findings, each with time, amount and advice: missed constraints;
/// constraints that were never active; a floor that legs do not reach; balance that is
/// off by more than 10 mm; joints with an added acceleration above 100 m/s2; a trunk that
/// is further from its source than kFarTrunk_deg.
[[nodiscard]] std::vector<Finding> assess_adapted(const AdaptArguments& args,
                                                  const AdaptRun& run);

}  // namespace marey::app
