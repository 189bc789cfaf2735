// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "recordings/motion/mot.h"

namespace marey {

/// How far two columns, or two joints, are from each other over the rows of one file that
/// the other covers. In the columns' unit; angles in radians, and a difference of full
/// turns is none.
struct Difference {
  std::size_t rows = 0;
  double offset = 0.0;  ///< The mean difference: of joints, how far that is turned.
  double rms = 0.0;     ///< Of what is left without it.
  double worst = 0.0;
};

/// `mine` at the times of `theirs` that it covers, `shift_s` later than it says itself.
[[nodiscard]] Difference compare_columns(const recordings::MotTable& mine,
                                         std::size_t column,
                                         const recordings::MotTable& theirs,
                                         std::size_t their_column,
                                         double shift_s = 0.0);

/// Angles about Z, X and Y, each axis carried along by those before.
struct AngleTriple {
  std::array<std::string, 3> columns;
};

/// Of pelvis, trunk, hips and shoulders.
[[nodiscard]] std::vector<AngleTriple> angle_triples();

/// The three angles as the one rotation that they are.
[[nodiscard]] Difference compare_rotations(const recordings::MotTable& mine,
                                           const recordings::MotTable& theirs,
                                           const AngleTriple& triple,
                                           double shift_s = 0.0);

/// Turns round the columns that have this name, with or without a side; false when there
/// is none.
[[nodiscard]] bool negate_columns(recordings::MotTable& table, const std::string& name);

}  // namespace marey
