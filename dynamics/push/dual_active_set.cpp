// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/push/dual_active_set.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/base/assert.h"

namespace marey::dynamics {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
/// A row counts as dependent on the active ones if its free part, squared, is below this
/// share of the row. Two force rows 1e-4 of a push apart are at 1e-6.
constexpr double kDependent = 1e-13;
constexpr int kMaxRounds = 4 * kProgramSize;

constexpr std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

double dot_rows(const ProgramRow& a, const ProgramRow& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

struct Rotation {
  double c = 1.0, s = 0.0;
};
/// Returns the rotation that takes (a, b) to (length, 0).
Rotation rotation_to_first(double a, double b) {
  const double length = std::hypot(a, b);
  return length > 0.0 ? Rotation{a / length, b / length} : Rotation{};
}

}  // namespace

ProgramMatrix inverse_root(const ProgramMatrix& m) {
  ProgramMatrix lower{};
  for (int i = 0; i < kProgramSize; ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = m[at(i)][at(j)];
      for (int k = 0; k < j; ++k) sum -= lower[at(i)][at(k)] * lower[at(j)][at(k)];
      lower[at(i)][at(j)] = i == j ? std::sqrt(sum) : sum / lower[at(j)][at(j)];
    }
  }
  // J = L^-T, so column j of J is row j of L^-1.
  ProgramMatrix root{};
  for (int j = 0; j < kProgramSize; ++j) {
    for (int i = j; i < kProgramSize; ++i) {
      double sum = i == j ? 1.0 : 0.0;
      for (int k = j; k < i; ++k) sum -= lower[at(i)][at(k)] * root[at(j)][at(k)];
      root[at(j)][at(i)] = sum / lower[at(i)][at(i)];
    }
  }
  return root;
}

DualActiveSet::Direction DualActiveSet::direction_of(const ProgramRow& row) const {
  Direction out;
  for (int i = 0; i < kProgramSize; ++i) {
    const double value = row[at(i)];
    if (value == 0.0) continue;
    for (int j = 0; j < kProgramSize; ++j) {
      out.in_root[at(j)] += root_[at(i)][at(j)] * value;
    }
  }
  double free_part = 0.0;
  for (int j = count_; j < kProgramSize; ++j) {
    free_part += out.in_root[at(j)] * out.in_root[at(j)];
  }
  if (free_part > kDependent * dot_rows(out.in_root, out.in_root)) {
    out.gain = free_part;
    for (int i = 0; i < kProgramSize; ++i) {
      for (int j = count_; j < kProgramSize; ++j) {
        out.step[at(i)] += root_[at(i)][at(j)] * out.in_root[at(j)];
      }
    }
  }
  for (int i = count_ - 1; i >= 0; --i) {
    double sum = out.in_root[at(i)];
    for (int j = i + 1; j < count_; ++j) {
      sum -= triangle_[at(i)][at(j)] * out.multiplier_step[at(j)];
    }
    out.multiplier_step[at(i)] = sum / triangle_[at(i)][at(i)];
  }
  return out;
}

DualActiveSet::Block DualActiveSet::first_block(const Direction& direction) const {
  Block out{.length = kInfinite};
  for (int i = 0; i < count_; ++i) {
    const Active& a = active_[at(i)];
    const double r = direction.multiplier_step[at(i)];
    if (r == 0.0) continue;
    const double length = r > 0.0 ? (a.multiplier - a.min_multiplier) / r
                                  : (a.max_multiplier - a.multiplier) / -r;
    if (length < out.length) out = {std::max(length, 0.0), i, r < 0.0};
  }
  return out;
}

bool DualActiveSet::add(const ProgramRule& rule) {
  ProgramRow row = rule.row;
  double bound = rule.bound;
  Active entering{
      0.0, rule.min_multiplier, rule.max_multiplier, rule.elastic, rule.elastic_sign};
  if (rule.min_multiplier < 0.0 && dot_rows(row, point_) > bound) {
    for (double& value : row) value = -value;
    bound = -bound;
    entering.sign = -entering.sign;
    entering.min_multiplier = -rule.max_multiplier;
    entering.max_multiplier = -rule.min_multiplier;
  }
  if (rule.elastic >= 0) released_[at(rule.elastic)] = 0.0;

  for (int round = 0; round < kMaxRounds; ++round) {
    const Direction direction = direction_of(row);
    const Block block = first_block(direction);
    const double missing = bound - dot_rows(row, point_);
    const double full = direction.gain > 0.0 ? missing / direction.gain : kInfinite;
    const double limit = entering.max_multiplier - entering.multiplier;
    const double length = std::min({block.length, full, limit});
    if (!(length < kInfinite)) return false;
    if (direction.gain > 0.0) {
      for (std::size_t i = 0; i < point_.size(); ++i) {
        point_[i] += length * direction.step[i];
      }
    }
    for (int i = 0; i < count_; ++i) {
      active_[at(i)].multiplier -= length * direction.multiplier_step[at(i)];
    }
    entering.multiplier += length;
    if (length == full) {
      append(direction.in_root, entering);
      return true;
    }
    if (length == limit) {
      release(entering, true);
      return true;
    }
    drop(block.index, block.at_max);
  }
  return false;
}

void DualActiveSet::append(ProgramRow in_root, const Active& active) {
  for (int j = kProgramSize - 1; j > count_; --j) {
    const Rotation turn = rotation_to_first(in_root[at(j - 1)], in_root[at(j)]);
    if (turn.s == 0.0 && turn.c == 1.0) continue;
    in_root[at(j - 1)] = turn.c * in_root[at(j - 1)] + turn.s * in_root[at(j)];
    in_root[at(j)] = 0.0;
    for (ProgramRow& line : root_) {
      const double a = line[at(j - 1)];
      const double b = line[at(j)];
      line[at(j - 1)] = turn.c * a + turn.s * b;
      line[at(j)] = turn.c * b - turn.s * a;
    }
  }
  for (int i = 0; i <= count_; ++i) triangle_[at(i)][at(count_)] = in_root[at(i)];
  active_[at(count_)] = active;
  ++count_;
}

void DualActiveSet::drop(int index, bool at_max) {
  if (active_[at(index)].elastic >= 0) release(active_[at(index)], at_max);
  for (int j = index; j + 1 < count_; ++j) {
    active_[at(j)] = active_[at(j + 1)];
    for (int i = 0; i <= j + 1; ++i)
      triangle_[at(i)][at(j)] = triangle_[at(i)][at(j + 1)];
  }
  --count_;
  for (int j = index; j < count_; ++j) {
    const Rotation turn =
        rotation_to_first(triangle_[at(j)][at(j)], triangle_[at(j + 1)][at(j)]);
    for (int k = j; k < count_; ++k) {
      const double a = triangle_[at(j)][at(k)];
      const double b = triangle_[at(j + 1)][at(k)];
      triangle_[at(j)][at(k)] = turn.c * a + turn.s * b;
      triangle_[at(j + 1)][at(k)] = turn.c * b - turn.s * a;
    }
    for (ProgramRow& line : root_) {
      const double a = line[at(j)];
      const double b = line[at(j + 1)];
      line[at(j)] = turn.c * a + turn.s * b;
      line[at(j + 1)] = turn.c * b - turn.s * a;
    }
  }
}

void DualActiveSet::release(const Active& active, bool at_max) {
  MAREY_ASSERT(active.elastic >= 0);
  released_[at(active.elastic)] = at_max ? -active.sign : active.sign;
}

std::optional<double> DualActiveSet::released_sign(int elastic) const {
  const double sign = released_[at(elastic)];
  return sign == 0.0 ? std::nullopt : std::optional(sign);
}

}  // namespace marey::dynamics
