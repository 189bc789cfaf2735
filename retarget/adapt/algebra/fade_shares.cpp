// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/adapt/algebra/fade_shares.h"

#include <algorithm>
#include <cstddef>

#include "core/base/smooth_step.h"

namespace marey::retarget {
namespace {

constexpr double kWithin_rad = 1e-4;
constexpr double kBeyond_rad = 0.03;

// In units of the precision of balance: no correction below the first value, full
// correction from the second on. A straight limb amplifies the smallest motion of its
// root.
constexpr double kNearEnough = 0.1;
constexpr double kWholly = 0.4;

}  // namespace

void limit_shares(std::span<float> angles) {
  for (float& angle : angles) {
    const auto beyond_rad = static_cast<double>(angle);
    angle = static_cast<float>(
        smooth_step((kBeyond_rad - beyond_rad) / (kBeyond_rad - kWithin_rad)));
  }
}

void settle_shares(std::span<float> errors, std::span<const float> precisions) {
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const auto off = static_cast<double>(errors[i]);
    const double relative = off / std::max(static_cast<double>(precisions[i]), 1e-9);
    errors[i] = static_cast<float>(
        smooth_step((relative - kNearEnough) / (kWholly - kNearEnough)));
  }
}

}  // namespace marey::retarget
