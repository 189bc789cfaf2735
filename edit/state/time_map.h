// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/constraint.h"
#include "core/edit/annotation.h"
#include "core/edit/contact_edit.h"

namespace marey::edit {

/// The map of times from a motion to its resampled form, linear between frames, and
/// beyond its ends with the speed that it has there.
class TimeMap {
 public:
  /// As resample_state(). `at_frame` must outlive the map.
  /// Precondition: ascends strictly; rates above 0.
  TimeMap(std::span<const double> at_frame, double old_hz, double new_hz)
      : at_frame_(at_frame), old_hz_(old_hz), new_hz_(new_hz) {}

  /// Returns the time in the result of an instant of the old motion. [s]
  [[nodiscard]] double new_time_s(double old_time_s) const;

  /// Returns what remains of the annotations: events within the result, spans cut at its
  /// ends. A rounding error before the start or after the end counts as within.
  [[nodiscard]] std::vector<Annotation> mapped(
      const std::vector<Annotation>& notes) const;
  /// Returns the constraints that are active at some time of the result. Fades keep
  /// their part of the motion. One that was active from the start or to the end of the
  /// motion remains so.
  [[nodiscard]] ConstraintSet mapped(const ConstraintSet& set) const;
  [[nodiscard]] std::vector<ContactEdit> mapped(
      const std::vector<ContactEdit>& edits) const;

 private:
  [[nodiscard]] double end_s() const {
    return static_cast<double>(at_frame_.size() - 1) / new_hz_;
  }

  std::span<const double> at_frame_;
  double old_hz_;
  double new_hz_;
};

}  // namespace marey::edit
