// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "engine/sync/phases.h"

namespace marey::engine {

/// A clip that is to be synchronised.
struct SyncSide {
  std::span<const Phase> phases;  ///< phases_of() its clip.
  double duration_s = 0.0;        ///< Duration of the clip.
  bool loops = false;
  double now_s = 0.0;  ///< Place in the clip now; in [0, duration] if it does not loop.
  double speed = 1.0;  ///< Clip seconds per second that its user asked for: > 0.
};

}  // namespace marey::engine
