// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace marey::library {

struct PlainWarp {
  double sum = std::numeric_limits<double>::infinity();
  int first_row = -1;
  int last_row = -1;
};

/// Aligns a query with a clip by trying every path of the steps (1,1), (2,1) and (1,2),
/// one after the other, in double. Exponential in rows. The step (2,1) also counts the
/// row of the query that it passes, and (1,2) the passed row of the clip.
class PlainAligner {
 public:
  PlainAligner(const std::vector<float>& query,
               const std::vector<float>& clip,
               bool whole)
      : n_(static_cast<int>(query.size() / 64)),
        m_(static_cast<int>(clip.size() / 64)),
        whole_(whole) {
    for (int i = 0; i < n_; ++i) {
      for (int j = 0; j < m_; ++j) {
        double sum = 0.0;
        for (int c = 0; c < 64; ++c) {
          const double d =
              static_cast<double>(query[static_cast<std::size_t>(64 * i + c)]) -
              clip[static_cast<std::size_t>(64 * j + c)];
          sum += d * d;
        }
        costs_.push_back(std::sqrt(sum));
      }
    }
  }

  [[nodiscard]] PlainWarp best() {
    for (int j = 0; j < (whole_ ? 1 : m_); ++j) walk(0, j, cost(0, j), j);
    return best_;
  }

 private:
  [[nodiscard]] double cost(int i, int j) const {
    return i < n_ && j < m_ ? costs_[static_cast<std::size_t>(i * m_ + j)]
                            : std::numeric_limits<double>::infinity();
  }
  void walk(int i, int j, double sum, int start) {
    if (i >= n_ || j >= m_) return;
    if (i == n_ - 1) {
      if ((!whole_ || j == m_ - 1) && sum < best_.sum) best_ = {sum, start, j};
      return;
    }
    const double next = sum + cost(i + 1, j + 1);
    walk(i + 1, j + 1, next, start);
    walk(i + 2, j + 1, next + cost(i + 2, j + 1), start);
    walk(i + 1, j + 2, next + cost(i + 1, j + 2), start);
  }

  int n_ = 0;
  int m_ = 0;
  bool whole_ = false;
  std::vector<double> costs_;
  PlainWarp best_;
};

}  // namespace marey::library
