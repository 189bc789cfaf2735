// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "engine/clips/motion_base.h"
#include "engine/clips/sample_clip.h"
#include "engine/sources/live_posture.h"

#include "tests/engine/made_base.h"

namespace marey::engine {

/// A performer who does what a clip of made_base() shows, at another tempo.
struct MadePerformer {
  std::shared_ptr<const MotionBase> base = made_base();
  std::string_view clip = "walk";
  double tempo = 1.0;    ///< Clip seconds per second.
  double start_s = 0.3;  ///< Time of the clip at time 0.

  [[nodiscard]] LivePosture at(double time_s) const {
    const MotionClip& shown = base->clip(*base->find(clip));
    const double source_s = start_s + tempo * time_s;
    LivePosture out;
    out.time_s = time_s;
    sample_clip(shown, source_s, out.posture);
    out.root_legs = path_at(shown, source_s);
    out.sigma_m.fill(0.01F);
    out.bears = bearing_at(shown, source_s);
    return out;
  }
};

}  // namespace marey::engine
