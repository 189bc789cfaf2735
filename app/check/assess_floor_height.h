// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>

#include "core/finding.h"
#include "core/motion.h"
#include "recordings/session/session.h"

namespace marey::app {

/// Height of a body's lower sole above the floor, in the lowest frames of a trial. [m]
struct SoleHeight {
  std::string trial;
  double height_m = 0.0;
};

/// Returns the 5 % quantile over frames of the lower ankle's height minus an average
/// person's ankle height at that stature. [m] Toes are not used: the fit places them on
/// the given floor. Ankles with a sigma above 30 mm do not count. nullopt if no ankle
/// counts in half of the frames.
[[nodiscard]] std::optional<double> sole_height_m(const EstimatedMotion& estimate,
                                                  double stature_m);

/// Compares the floor with the soles of the subject in the static trial, `standing`, and
/// with the lowest soles of the motions. Equal heights in the motions indicate a wrong
/// floor; other heights indicate a subject who stood on an object. Returns nullopt if the
/// soles are less than 50 mm above the floor and less than 25 mm below it. The finding
/// names the key to correct or the trial to repeat. It is poor beyond 65 mm above or 40
/// mm below, as shoes do not explain more, and fair if the session has no floor trial.
[[nodiscard]] std::optional<Finding> assess_floor_height(
    const recordings::Session& session,
    const SoleHeight& standing,
    std::span<const SoleHeight> motions);

}  // namespace marey::app
