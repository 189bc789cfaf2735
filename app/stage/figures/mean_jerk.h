// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace marey::app {

/// Mean jerk of points that are given step by step: the third difference of each, over
/// the step cubed. Constant cost a step.
class MeanJerk {
 public:
  /// Precondition: step_s > 0.
  explicit MeanJerk(double step_s) : step_s_(step_s) {}
  /// Adds the places of all points in the next step. Precondition: as many as before.
  void add(std::span<const glm::dvec3> points_in_world);
  /// Forgets the last steps: the next one does not continue them.
  void interrupt() { known_ = 0; }
  [[nodiscard]] std::size_t count() const { return count_; }
  /// [m/s^3] Precondition: count() > 0.
  [[nodiscard]] double mean_m_s3() const { return sum_ / static_cast<double>(count_); }

 private:
  double step_s_ = 0.0;
  std::vector<glm::dvec3> last_[3];  ///< The newest first.
  std::size_t known_ = 0;
  double sum_ = 0.0;
  std::size_t count_ = 0;
};

}  // namespace marey::app
