// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "engine/sync/phases.h"

namespace marey::engine {

/// The phases of a clip over unwrapped time. The phases of a clip that loops repeat
/// without end; its last and first phase are one if their feet are the same. The first
/// phase of another clip has no start, and its last one no end: the clip holds its last
/// posture. Refers to the phases; allocates nothing.
class PhaseRing {
 public:
  /// One phase of one repetition.
  struct Place {
    std::size_t index = 0;
    double offset_s = 0.0;  ///< Unwrapped time of the start of the repetition.
  };

  /// Precondition: at least one phase; a clip that loops lasts.
  PhaseRing(std::span<const Phase> phases, double duration_s, bool loops);

  /// Number of changes of feet in a repetition.
  [[nodiscard]] std::size_t edges() const;
  /// Returns the phase with start <= source < end. Logarithmic in phases.
  [[nodiscard]] Place at(double source_s) const;
  /// Precondition: the phase has an end.
  [[nodiscard]] Place next(Place place) const;
  /// Precondition: the phase has a start.
  [[nodiscard]] Place previous(Place place) const;
  [[nodiscard]] PhaseClass feet(Place place) const { return phases_[place.index].feet; }
  /// Unwrapped; minus infinity without a start. [s]
  [[nodiscard]] double start_s(Place place) const;
  /// Unwrapped; infinity without an end. [s]
  [[nodiscard]] double end_s(Place place) const;
  /// Returns the time in or before the phase from which on it is more than kFlightEdge_s
  /// after the last edge between a flight and a bearing phase.
  [[nodiscard]] double after_edge_s(Place place) const;
  /// Returns the time in or after the phase up to which it is more than kFlightEdge_s
  /// before the next such edge.
  [[nodiscard]] double before_edge_s(Place place) const;

 private:
  std::span<const Phase> phases_;  ///< Without a first phase that is part of the last.
  double duration_s_ = 0.0;
  bool loops_ = false;
};

}  // namespace marey::engine
