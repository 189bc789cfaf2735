// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/jumps/jump.h"
#include "dynamics/push/force_push.h"

#include "benchmarks/dynamics/jump_clips.h"

namespace marey {

/// Height of the centre of mass between two instants of a captured support.
struct CapturedPush {
  std::string name;
  std::string person;
  std::string kind;  ///< "jump" or "run".
  /// States of the fitted curve at both ends; accelerations are not set.
  dynamics::PushEnds ends;
  dynamics::PushReference reference;  ///< Two samples per frame.
  bool from_touchdown = false;
  std::vector<double> time_s;    ///< Frames inside, from the start of the push.
  std::vector<double> height_m;  ///< Captured, not smoothed.
  double lowest_at = 0.0;        ///< Share of the duration.
  double lowest_m = 0.0;
};

/// Returns the support from start_s to end_s, fitted by fit_push(). nullopt: too short.
[[nodiscard]] std::optional<CapturedPush> captured_push(const JumpClip& clip,
                                                        double start_s,
                                                        double end_s,
                                                        bool from_touchdown);

/// Returns all pushes that find_jumps() finds in the clip; DJ1's times are the plates'.
[[nodiscard]] std::vector<CapturedPush> captured_pushes(const JumpClip& clip);

/// Root mean square and worst distance of a curve from the captured heights. [mm]
struct HeightError {
  double rms_mm = 0.0;
  double worst_mm = 0.0;
};
template <class Curve>
[[nodiscard]] HeightError height_error(const CapturedPush& push, const Curve& height_m) {
  HeightError out;
  double squares = 0.0;
  for (std::size_t i = 0; i < push.time_s.size(); ++i) {
    const double off_mm = 1e3 * (height_m(push.time_s[i]) - push.height_m[i]);
    squares += off_mm * off_mm;
    out.worst_mm = off_mm < 0.0 ? (out.worst_mm < -off_mm ? -off_mm : out.worst_mm)
                                : (out.worst_mm < off_mm ? off_mm : out.worst_mm);
  }
  out.rms_mm = std::sqrt(squares / static_cast<double>(push.time_s.size()));
  return out;
}

/// Represents the push by cubic splines alone: the least squares fit of the force whose
/// moments are those of the ends. `coefficients` at least 6.
[[nodiscard]] HeightError represent_by_splines(const CapturedPush& push,
                                               int coefficients);

}  // namespace marey
