// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/base/quantile.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/base/assert.h"

namespace marey {

double quantile(std::vector<double> values, double share) {
  MAREY_ASSERT(!values.empty() && share >= 0.0 && share <= 1.0);
  const auto place = static_cast<std::ptrdiff_t>(
      std::floor(share * static_cast<double>(values.size() - 1) + 0.5));
  const auto found = values.begin() + place;
  std::nth_element(values.begin(), found, values.end());
  return *found;
}

double median(std::vector<double> values) {
  return quantile(std::move(values), 0.5);
}

}  // namespace marey
