// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: which lens cameras have, and whether they run on one clock.

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "calib/refine_rig.h"
#include "calib/rig_model.h"
#include "core/camera.h"
#include "core/detection.h"
#include "core/result.h"

namespace marey::calib {

/// Cameras as the bundle leaves them, not judged yet.
struct SolvedRig {
  RigModel model;
  RefineOptions refine;
  /// nullopt: there is no minimum.
  std::optional<RigDoubt> doubt;
};

/// A rig of that lens before it is refined (`doubt` is none), or why there is none.
using FirstModel = std::function<Result<SolvedRig>(LensModel)>;

/// Of all lenses, the one that does best on frames it did not see; the simpler one unless
/// it is clearly beaten (predicts_better()): five terms before four of another kind,
/// before eight.
[[nodiscard]] LensModel choose_lens(const FirstModel& first_model);

/// What clocks are solved for.
struct Clocks {
  bool offsets = false;
  bool drifts = false;
  bool line_delays = false;
};

/// With clocks where they are needed, as far as the cameras' pictures tell: when the
/// cameras run at several rates, when their errors follow what moves, or when they fit
/// badly as one (many sightings of a camera do not go with the rest) and clearly better
/// with clocks. `clocks_may_unplace`: that nothing joins cameras may be their clocks'
/// doing too, and is not yet an error. `line_delays`: they are solved for, once it is
/// settled whether clocks are.
[[nodiscard]] Result<SolvedRig> solve_choosing_clocks(
    std::span<const std::string> names,
    std::span<const CameraDetections> waved,
    bool clocks_may_unplace,
    bool line_delays,
    const std::function<Result<SolvedRig>(const Clocks&)>& solve);

}  // namespace marey::calib
