// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/check_stature.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "reconstruct/body_stature.h"

namespace marey::app {

std::optional<std::string> stature_warning(const Body& body) {
  constexpr double kSigmas = 3.0;
  std::array<bool, kHumanBoneCount> measured{};
  // Legs alone: tags measure the rotation of the trunk better than its length.
  for (const HumanLimb& limb : human_limbs()) {
    if (limb.end != HumanBone::kLeftFoot && limb.end != HumanBone::kRightFoot) continue;
    measured[index(limb.lower)] = true;
    measured[index(limb.end)] = true;
  }
  const auto by_legs = reconstruct::stature_of_body(body.proportions, measured);
  if (!by_legs ||
      std::abs(by_legs->stature_m - body.stature_m) < kSigmas * by_legs->sigma_m) {
    return std::nullopt;
  }
  std::array<char, 200> text{};
  std::snprintf(text.data(),
                text.size(),
                "stature_m of [subject] is %.2f m, but the legs are as long as those of "
                "a person of %.2f m (standard deviation %.2f m)",
                body.stature_m,
                by_legs->stature_m,
                by_legs->sigma_m);
  return std::string(text.data()) +
         ". Next: correct stature_m; if it is right, check size_m of the tags and "
         "tag_size_m of [board].";
}

}  // namespace marey::app
