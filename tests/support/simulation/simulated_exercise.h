// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "tests/support/simulation/simulated_body.h"

namespace marey::testing {

/// One angle that swings for a while about a middle: middle + amplitude * sin(...), faded
/// in and out.
struct AngleWave {
  std::size_t angle = 0;  ///< Position in an Attitude.
  double middle = 0.0;
  double amplitude = 0.0;
  double hz = 0.5;
  double phase_rad = 0.0;
  double from_s = 0.0;
  double to_s = 0.0;
};

/// A movement: a posture, and waves about it.
struct Exercise {
  std::string name;
  double duration_s = 0.0;
  Attitude base{};
  std::vector<AngleWave> waves;
  glm::dvec2 velocity_m{0.0};  ///< Along X and Z of the floor. [m/s]

  [[nodiscard]] Attitude at(double time_s) const;
};

/// Thoroughness of a range of motion.
enum class Diligence {
  kGood,  ///< Every joint in turn, 20 to 40 s.
  kLazy,  ///< All at once and little, some joints not at all, 6 s.
};

/// Standing for one to three seconds in a T or an A pose, as people do: swaying slightly,
/// feet turned out, knees a little bent. `heading_rad` as Angle::kHeading.
[[nodiscard]] Exercise draw_standing(Dice& dice, double heading_rad);

/// A range of motion about the given heading.
[[nodiscard]] Exercise draw_range_of_motion(Dice& dice,
                                            Diligence diligence,
                                            double heading_rad);

/// A walk, a reach, squats or arm swings, two to four seconds.
[[nodiscard]] Exercise draw_motion(Dice& dice, double heading_rad);

}  // namespace marey::testing
