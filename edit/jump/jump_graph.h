// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "dynamics/jumps/jump.h"
#include "dynamics/push/thesis_push.h"
#include "edit/state/edit_state.h"
#include "edit/state/op_report.h"

#include "core/base/result.h"
#include "core/edit/edit_ops.h"

namespace marey::edit {

/// Curves of one jump before and after the operation `jump`, for display. Times are those
/// of the new motion; the captured curves are shown at the new times of their phases.
struct JumpGraph {
  std::vector<double>
      time_s;  ///< Ascending. The other curves have its size, or are empty.
  std::vector<double> height_m;  ///< Centre of mass, world Y.
  std::vector<double> captured_height_m;
  std::vector<double> push_g;  ///< Vertical push, in multiples of the gravity.
  std::vector<double> captured_push_g;
  double start_s = 0.0;  ///< P1 to P5 of the new motion.
  double lowest_s = 0.0;
  double takeoff_s = 0.0;
  double apex_s = 0.0;
  double landing_s = 0.0;
  double end_s = 0.0;
  double strength_g = 0.0;  ///< Largest push that the plan allows.
  /// Lowest points of the thesis law; empty: none, or another law.
  std::vector<dynamics::SpaceColumn> space;
  double space_lowest_at = 0.0;  ///< Lowest point of the plan, within the space.
  double space_lowest_m = 0.0;
  std::string refusal;  ///< Why there is no plan; the new curves are empty then.
  /// All jumps of the span, as captured. JumpOp::jump counts them from 1.
  std::vector<dynamics::Jump> jumps;
};

/// Computes the curves of the jump that an operation makes of `state`. Cost: as the
/// operation without its body. Errors: those of the operation, but for wishes that cannot
/// be met: these are JumpGraph::refusal.
[[nodiscard]] Result<JumpGraph> jump_graph(const JumpOp& op,
                                           const OpContext& context,
                                           const EditState& state);

}  // namespace marey::edit
