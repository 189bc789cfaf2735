// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/plant.h"

#include "edit/state/check_op_keys.h"
#include "edit/state/op_weights.h"
#include "edit/state/plant_feet.h"
#include "edit/state/resample_state.h"

namespace marey::edit {

Result<EditState> apply_plant(const PlantOp& /*op*/,
                              const OpContext& context,
                              const EditState& state,
                              OpReport& report) {
  if (const Status ok = check_op_keys(context.op, {.span = true, .blend = true}); !ok) {
    return ok.error();
  }
  const auto weights = op_weights(state, context.op);
  if (!weights) return weights.error();
  EditState out = state;
  const PlantReport planted = plant_feet(out);
  mix_motion(state.motion, *weights, state, {}, out.motion);
  report.figures.emplace_back("slide_before_mm", planted.slide_before_mm);
  report.figures.emplace_back("slide_after_mm", measure_slide(out).worst_drift_mm);
  report.figures.emplace_back(
      "displaced_mm",
      1e3 * mark_displaced(out, state.motion, weights->frames, context.index));
  if (planted.unreachable_frames > 0) {
    report.findings.push_back(fair_finding(
        "reach",
        "plant",
        "in " + std::to_string(planted.unreachable_frames) +
            " frames a leg does not reach its footprint",
        "shorten the path, or remove the contact with the contacts operation"));
  }
  return out;
}

}  // namespace marey::edit
