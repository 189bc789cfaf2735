// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

namespace marey::dynamics {

/// Number of unknowns of the program, the same as kForceCoefficients.
inline constexpr int kProgramSize = 12;
using ProgramRow = std::array<double, kProgramSize>;
using ProgramMatrix = std::array<ProgramRow, kProgramSize>;

/// Returns J with J J' = M^-1, upper triangular. Precondition: M is symmetric and
/// positive definite.
[[nodiscard]] ProgramMatrix inverse_root(const ProgramMatrix& m);

/// One row of a program: row . x >= bound, or row . x = bound if its multiplier may be
/// negative. Finite limits of the multiplier make the row elastic: it may be broken at
/// the price of the limit per unit.
struct ProgramRule {
  ProgramRow row{};
  double bound = 0.0;
  double min_multiplier = 0.0;
  double max_multiplier = 0.0;
  /// 0 or 1: an elastic rule. -1: any other rule.
  int elastic = -1;
  /// 1, or released_sign() if the elastic rule is added again: `row` and `bound` have
  /// this sign then, too.
  double elastic_sign = 1.0;
};

/// Minimises x'Mx / 2 under rules that arrive one after another: the dual active set
/// method of Goldfarb & Idnani (1983). The point is always the minimum under the active
/// rules. A caller looks for a broken rule, adds it, and repeats. Deterministic;
/// allocates nothing; some 0.5 microseconds per rule.
class DualActiveSet {
 public:
  /// `root` is inverse_root(M).
  explicit DualActiveSet(const ProgramMatrix& root) : root_(root) {}

  /// Moves the point to the minimum under the active rules and this one. Returns false
  /// if no point satisfies them all, or the rounds ended. Precondition: the rule is
  /// broken, or an equality.
  [[nodiscard]] bool add(const ProgramRule& rule);
  [[nodiscard]] const ProgramRow& point() const { return point_; }
  /// Returns the sign that the row of an elastic rule needs to be added again: the rule
  /// is released, and sign * (row . x - bound) >= 0 must hold from now on. nullopt: the
  /// rule is active, or was never added.
  [[nodiscard]] std::optional<double> released_sign(int elastic) const;

 private:
  struct Active {
    double multiplier = 0.0;
    double min_multiplier = 0.0;
    double max_multiplier = 0.0;
    int elastic = -1;
    double sign = 1.0;  ///< -1: the row is that of the first addition, negated.
  };
  struct Direction {
    ProgramRow in_root{};          ///< d = J' row.
    ProgramRow step{};             ///< z: change of the point.
    ProgramRow multiplier_step{};  ///< r: decrease of the multipliers.
    double gain = 0.0;             ///< z . row; 0 if the row depends on active ones.
  };
  struct Block {
    double length = 0.0;
    int index = -1;  ///< Active rule whose multiplier reaches a limit. -1: no rule.
    bool at_max = false;
  };

  [[nodiscard]] Direction direction_of(const ProgramRow& row) const;
  [[nodiscard]] Block first_block(const Direction& direction) const;
  void append(ProgramRow in_root, const Active& active);
  void drop(int index, bool at_max);
  void release(const Active& active, bool at_max);

  ProgramMatrix root_{};      ///< J.
  ProgramMatrix triangle_{};  ///< R of the active rows; [row][column].
  std::array<Active, kProgramSize> active_{};
  int count_ = 0;
  ProgramRow point_{};
  std::array<double, 2> released_{};  ///< 0: not released.
};

}  // namespace marey::dynamics
