// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "engine/clips/rig.h"
#include "engine/clips/sample_clip.h"

namespace marey::engine {

/// A number for each foot part, in the order of ClipFootPart.
using PerFootPart = std::array<double, 4>;

/// Moves the root of a blend so that the feet that bear stand still.
class RootAnchor {
 public:
  /// Time constant of the filter on the bearing shares. [s]
  static constexpr double kSmoothing_s = 0.06;

  void reset() { *this = RootAnchor(); }

  /// Filters the shares `bears` with which the parts of the feet bear in the blend: the
  /// sum over its clips of weight times 0 or 1.
  void observe(const PerFootPart& bears, double step_s);
  [[nodiscard]] const PerFootPart& bears() const { return bears_; }

  /// Returns the displacement of the root over a step [m], in the heading frame before
  /// it: that for which the bearing parts of the feet stand still, mixed with the blended
  /// one by smooth_step(min(1, sum of shares)) times `strength` (0: the blended one). The
  /// turn is the blended one. `before`, `now`: the feet of the postures that are shown.
  [[nodiscard]] RootPlace displacement(const RootPlace& blended_m,
                                       const FootPlaces& before_legs,
                                       const FootPlaces& now_legs,
                                       double leg_length_m,
                                       double strength) const;

 private:
  bool is_known_ = false;
  PerFootPart bears_{};
};

}  // namespace marey::engine
