// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>

#include "core/base/result.h"
#include "core/motion.h"
#include "recordings/session/session.h"

namespace marey::app {

/// How high the lower one of a body's soles is above the floor, in a trial's lowest
/// frames. [m]
struct SoleHeight {
  std::string trial;
  double height_m = 0.0;
};

/// Returns the 5 % quantile over frames of the lower ankle's height minus an average
/// person's ankle height at that stature. [m] Toes are not used: the fit places them on
/// the floor that it is given. Ankles with a sigma above 30 mm do not count. nullopt if
/// none is known in half of the frames.
[[nodiscard]] std::optional<double> sole_height_m(const EstimatedMotion& estimate,
                                                  double stature_m);

/// A floor that is not where the subject stands.
struct FloorHeightFinding {
  Error error;           ///< kQuality, with the key to correct or the trial to repeat.
  bool is_poor = false;  ///< Too much for shoes; else a warning.
};

/// Compares the floor with who stands on it in the static trial, `standing`, and with the
/// lowest soles of the motions: they tell a floor that is wrong from a person who stood
/// on something. nullopt where soles are less than 50 mm above the floor and less than 25
/// mm below it; beyond 65 and 40 mm it is poor. Where no floor trial tells the floor,
/// only a warning.
[[nodiscard]] std::optional<FloorHeightFinding> assess_floor_height(
    const recordings::Session& session,
    const SoleHeight& standing,
    std::span<const SoleHeight> motions);

}  // namespace marey::app
