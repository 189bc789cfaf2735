// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/bones/named_neutrals.h"

#include <algorithm>
#include <array>

#include "core/base/angle.h"

namespace marey::retarget {
namespace {

constexpr std::array<std::string_view, 6> kBandaiJoints{
    "joint_Root", "UpperArm_L", "LowerArm_L", "UpperLeg_L", "LowerLeg_L", "Toes_L"};
constexpr std::array<std::string_view, 5> kCharacterCreatorJoints{"CC_Base_Hip",
                                                                  "CC_Base_Pelvis",
                                                                  "CC_Base_Waist",
                                                                  "CC_Base_Spine01",
                                                                  "CC_Base_L_Calf"};

const std::array kNamed{
    // The toe joint is 4.25 cm above the floor, the ankle 11.74 cm; they are 11.75 cm
    // apart.
    NamedNeutral{"bandai",
                 "Bandai Namco Research Motiondataset",
                 39.6 * kRadiansPerDegree,
                 0.053,
                 {},
                 kBandaiJoints},
    NamedNeutral{"iclone",
                 "Reallusion iClone, Character Creator",
                 14.0 * kRadiansPerDegree,
                 0.024,
                 {},
                 kCharacterCreatorJoints},
};

}  // namespace

std::span<const NamedNeutral> named_neutrals() {
  return kNamed;
}

const NamedNeutral* named_neutral(std::string_view name) {
  const auto* const found = std::ranges::find(kNamed, name, &NamedNeutral::name);
  return found == kNamed.end() ? nullptr : found;
}

const NamedNeutral* named_neutral(const Skeleton& skeleton) {
  for (const NamedNeutral& known : kNamed) {
    const bool is_this = std::ranges::all_of(known.joints, [&](std::string_view joint) {
      return skeleton.find(joint).has_value();
    });
    if (is_this) return &known;
  }
  return nullptr;
}

}  // namespace marey::retarget
