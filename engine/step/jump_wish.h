// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "dynamics/jumps/jump_wish.h"
#include "engine/actions/action.h"
#include <glm/vec3.hpp>

namespace marey::engine {

/// A request to play the jump of a clip with another apex, airtime or landing. It is
/// planned when it is requested; the planned motion is a clip of this character alone.
struct JumpWish {
  ActionWish action;
  int jump = 0;  ///< Number of the jump in the clip.
  /// Its landing_in_world stays empty.
  dynamics::JumpWish changes;
  /// Middle of the soles at landing, if the jump begins now and at its first frame.
  std::optional<glm::dvec3> landing_in_world{};
  dynamics::JumpTraits traits;
};

/// Answer about a jump.
struct JumpFeasibility {
  bool reachable = false;
  /// Distance from the captured landing to the wanted one, if it cannot be reached.
  double missing_m = 0.0;
  double duration_s = 0.0;  ///< From the first frame to the landing.
  int steps = 0;            ///< The same in steps of the engine.
  double apex_m = 0.0;      ///< Height of the centre of mass above the floor.
  double airtime_s = 0.0;
  std::string why;  ///< The cause, if it is not reachable.
};

}  // namespace marey::engine
