// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>

#include "core/motion.h"
#include "core/result.h"
#include "recordings/session.h"

namespace marey::app {

/// How high the lower one of a body's soles is above the floor, in a trial's lowest
/// frames. [m]
struct SoleHeight {
  std::string trial;
  double height_m = 0.0;
};

/// Estimates it from the ankles, which are as high above a flat sole as an average
/// person's of that stature; a twentieth of the frames are lower. (Where the toes are is
/// known from who stands on the floor: they follow a floor that is wrong.) Ankles that are
/// known to worse than 30 mm do not count. nullopt if none is known in half of the frames.
[[nodiscard]] std::optional<double> sole_height_m(const EstimatedMotion& estimate,
                                                  double stature_m);

/// A floor that is not where the subject stands.
struct SoleDoubt {
  Error error;           ///< kQuality, with the key to correct or the trial to repeat.
  bool is_poor = false;  ///< Too much for shoes; else a warning.
};

/// Compares the floor with who stands on it in the static trial, `standing`, and with the
/// lowest soles of the motions: they tell a floor that is wrong from a person who stood on
/// something. nullopt where all is well. Where no floor trial tells the floor, only a
/// warning.
[[nodiscard]] std::optional<SoleDoubt> judge_soles(const recordings::Session& session,
                                                   const SoleHeight& standing,
                                                   std::span<const SoleHeight> motions);

}  // namespace marey::app
