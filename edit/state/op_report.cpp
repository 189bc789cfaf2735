// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/state/op_report.h"

#include "retarget/body/place_masses.h"

namespace marey::edit {

Result<std::vector<PointMass>> masses_of(const OpContext& context,
                                         const EditState& state) {
  if (!context.inputs.masses.empty()) return context.inputs.masses;
  return retarget::place_masses(state.motion.skeleton, state.map, {});
}

}  // namespace marey::edit
