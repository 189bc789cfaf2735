// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "recordings/motion/mot.h"

namespace marey {

/// Difference of two columns, or of two joints, over the rows of one file that the other
/// covers. The unit is the columns' unit; angles are in radians, and a difference of full
/// turns counts as zero.
struct Difference {
  std::size_t rows = 0;
  double offset = 0.0;  ///< Mean difference; for joints, the mean rotation.
  double rms = 0.0;     ///< Root mean square of the residual without the offset.
  double worst = 0.0;
};

/// Compares `mine`, with its times increased by `shift_s`, at the times of `theirs` that
/// it covers.
[[nodiscard]] Difference compare_columns(const recordings::MotTable& mine,
                                         std::size_t column,
                                         const recordings::MotTable& theirs,
                                         std::size_t their_column,
                                         double shift_s = 0.0);

/// Angles about Z, X and Y; each rotation moves the axes of the following ones.
struct AngleTriple {
  std::array<std::string, 3> columns;
};

/// Returns the triples of pelvis, trunk, hips and shoulders.
[[nodiscard]] std::vector<AngleTriple> angle_triples();

/// Compares the three angles as one rotation.
[[nodiscard]] Difference compare_rotations(const recordings::MotTable& mine,
                                           const recordings::MotTable& theirs,
                                           const AngleTriple& triple,
                                           double shift_s = 0.0);

/// Negates the columns that have this name, with or without a side. Returns false when
/// there is no such column.
[[nodiscard]] bool negate_columns(recordings::MotTable& table, const std::string& name);

}  // namespace marey
