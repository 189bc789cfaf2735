// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "edit/state/edit_state.h"

#include "core/character.h"
#include "core/edit/edit_ops.h"
#include "core/finding.h"
#include "core/skeleton.h"

namespace marey::edit {

/// Files that operations need, read before. Keys are those of the recipe.
struct EditInputs {
  std::map<std::string, EditState> sources;  ///< By EditSource::id.
  std::map<std::string, Skeleton> avatars;   ///< By RetargetOp::avatar.
  /// Masses on the joints of the first source's body, for `jump`; empty: those of an
  /// average adult (retarget::place_masses()). Not valid after `retarget`.
  std::vector<PointMass> masses;
};

/// One operation and its surroundings, as an operation's function receives them.
struct OpContext {
  const EditOp& op;
  int index = 0;  ///< In EditRecipe::ops.
  const EditInputs& inputs;
};

/// Returns the masses of the inputs, or de Leva's where these have none. Errors:
/// retarget::place_masses()'s.
[[nodiscard]] Result<std::vector<PointMass>> masses_of(const OpContext& context,
                                                       const EditState& state);

/// Results of one operation, for its report.
struct OpReport {
  int index = 0;     ///< In EditRecipe::ops.
  std::string name;  ///< With its version: "cut@1".
  /// Measured values by name with unit: {"tilt_deg", 0.8}.
  std::vector<std::pair<std::string, double>> figures;
  std::vector<Finding> findings;
};

}  // namespace marey::edit
