// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/rig/solve_rig.h"

#include "calib/rig/apparent_faults.h"
#include "calib/rig/cross_validate.h"

namespace marey::calib {

Result<SolvedRig> solve_rig(std::span<const std::string> names,
                            std::span<const CameraDetections> waved,
                            bool clocks_may_unplace,
                            const RigOptions& options,
                            const SolveWithClocks& solve,
                            Steps& steps) {
  const auto solve_in_steps = [&](const Clocks& clocks) {
    auto one = solve(clocks);
    steps.step();
    return one;
  };
  auto solved =
      options.choose_clocks
          ? solve_choosing_clocks(names,
                                  waved,
                                  clocks_may_unplace,
                                  options.solve_line_delays,
                                  solve_in_steps)
          : solve(
                {options.solve_offsets, options.solve_drifts, options.solve_line_delays});
  steps.reach(kSolveSteps);
  return solved;
}

void set_unknowns(const RigOptions& options, std::size_t cameras, RefineOptions& refine) {
  refine.offsets = options.solve_offsets;
  refine.drifts = options.solve_drifts;
  refine.line_delays = options.solve_line_delays;
  for (std::size_t c = 0; c < cameras; ++c) {
    refine.held_lenses.push_back(options.has_lens(c));
  }
}

void validate_rig(const SolvedRig& solved,
                  const RigOptions& options,
                  double rate_hz,
                  Steps& steps,
                  CalibratedRig& rig) {
  rig.apparent_line_delays = apparent_line_delays(solved.model, solved.refine, rate_hz);
  steps.step();
  rig.apparent_move = apparent_move(solved.model, solved.refine, rate_hz);
  steps.step();
  if (options.cross_validate) {
    rig.cross_validation = cross_validate(solved.model, solved.refine, steps);
    widen_by_halves(rig);
  }
  steps.finish();
}

}  // namespace marey::calib
