// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "engine/detail/distribute.h"

namespace marey::engine {

/// Minimum time from one change of a character's detail to the next. [s]
inline constexpr double kDetailHold_s = 0.5;
/// Time in which a stage of the solver fades in or out. [s]
inline constexpr double kDetailFade_s = 0.2;

/// The detail of one character over time, without popping and without flicker.
/// A change happens at the earliest kDetailHold_s after the one before it. A rise also
/// requires that the budget has granted it for that long; the lowest detail granted in
/// that time is taken. A fall otherwise happens at once. Stages that the new level adds
/// or drops fade with smooth_step() over kDetailFade_s; changes do not overlap, so each
/// fade begins and ends at rest: speed and acceleration of the activations are
/// continuous. After a fall of the budget, the cost may therefore exceed it for
/// kDetailHold_s + kDetailFade_s.
class LevelFade {
 public:
  /// Begins with this detail, without a fade.
  explicit LevelFade(const Detail& start = {}) : now_(start), from_level_(start.level) {}

  /// Proceeds by a step with the detail that the budget grants. Allocates nothing.
  /// Precondition: step_s > 0.
  void advance(const Detail& granted, double step_s);

  /// Detail that is in force. Its level is the one that is being faded to.
  [[nodiscard]] Detail detail() const { return now_; }
  /// Level that must be computed: the higher one during a fade.
  [[nodiscard]] int computed_level() const {
    return is_fading() && from_level_ > now_.level ? from_level_ : now_.level;
  }
  [[nodiscard]] bool is_fading() const { return since_s_ < kDetailFade_s - kRounding_s; }

  // Activations of the stages, 0 to 1: supports and constraints (level 1), balance
  // (level 2), dynamics (level 3). With constraint activations of their own, multiply.
  [[nodiscard]] double supports() const { return activation(1); }
  [[nodiscard]] double balance() const { return activation(2); }
  [[nodiscard]] double dynamics() const { return activation(3); }

  /// True if a step is computed rather than interpolated. The steps of characters with
  /// different ids are spread evenly. During a fade each step is.
  [[nodiscard]] bool is_due(std::uint64_t step, std::uint32_t id) const;

 private:
  /// Sums of step lengths differ from their products by rounding.
  static constexpr double kRounding_s = 1e-9;

  [[nodiscard]] double activation(int level) const;
  void change(const Detail& to);

  Detail now_;
  std::uint8_t from_level_ = 0;
  double since_s_ = kDetailHold_s;  // Since the last change.
  Detail risen_;                    // Lowest detail granted above now_.
  double granted_s_ = 0.0;          // Time for which a rise has been granted.
};

}  // namespace marey::engine
