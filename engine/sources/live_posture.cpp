// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/sources/live_posture.h"

#include <cmath>
#include <optional>
#include <string>

namespace marey::engine {
namespace {

Status posture_error(std::string cause) {
  return bad_input("live posture", std::move(cause), "leave this posture out");
}

bool are_finite(const BlendPosture& posture) {
  float sum = posture.height_legs + posture.abdomen_share + posture.torso_share;
  for (const auto* limbs : {&posture.fold_rad,
                            &posture.mid_x,
                            &posture.mid_y,
                            &posture.upper_twist_rad,
                            &posture.lower_twist_rad}) {
    for (const float value : *limbs) sum += value;
  }
  return std::isfinite(sum);
}

bool are_unit(const BlendPosture& posture) {
  for (std::size_t i = 0; i < kPostureRotations; ++i) {
    const float square = posture.x[i] * posture.x[i] + posture.y[i] * posture.y[i] +
                         posture.z[i] * posture.z[i] + posture.w[i] * posture.w[i];
    // Also false for numbers that are not finite.
    if (!(std::abs(square - 1.0F) < 2e-3F)) return false;
  }
  return true;
}

bool are_folds(const BlendPosture& posture) {
  constexpr float kFolded_rad = 1.5708F;
  for (const float fold_rad : posture.fold_rad) {
    if (!(fold_rad >= 0.0F && fold_rad <= kFolded_rad)) return false;
  }
  return true;
}

}  // namespace

Status check_live_posture(const LivePosture& posture) {
  const RootPlace& root = posture.root_legs;
  if (!std::isfinite(posture.time_s)) return posture_error("its time is not finite");
  if (!std::isfinite(root.x_m + root.z_m + root.heading_rad)) {
    return posture_error("its place is not finite");
  }
  if (!are_finite(posture.posture)) return posture_error("a number is not finite");
  if (!are_unit(posture.posture)) {
    return posture_error("a rotation is not of unit length");
  }
  if (!are_folds(posture.posture)) {
    return posture_error("the fold of a limb is not in [0, pi/2]");
  }
  for (const float sigma_m : posture.sigma_m) {
    if (!(std::isfinite(sigma_m) && sigma_m >= 0.0F)) {
      return posture_error("a sigma is negative or not finite");
    }
  }
  if (posture.bears > 15U) return posture_error("it has a foot with unknown parts");
  return Done{};
}

}  // namespace marey::engine
