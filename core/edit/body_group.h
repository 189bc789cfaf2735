// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace marey {

/// Parts of a body to which an edit operation can be limited.
enum class EditGroup { kRoot, kTrunk, kHead, kLeftArm, kRightArm, kLeftLeg, kRightLeg };

inline constexpr std::array<EditGroup, 7> kEditGroups{EditGroup::kRoot,
                                                      EditGroup::kTrunk,
                                                      EditGroup::kHead,
                                                      EditGroup::kLeftArm,
                                                      EditGroup::kRightArm,
                                                      EditGroup::kLeftLeg,
                                                      EditGroup::kRightLeg};

/// Returns the name in recipes: "root", "left_arm".
[[nodiscard]] constexpr std::string_view name(EditGroup group) {
  constexpr std::array<std::string_view, 7> kNames{
      "root", "trunk", "head", "left_arm", "right_arm", "left_leg", "right_leg"};
  return kNames[static_cast<std::size_t>(group)];
}

/// Returns the group of this name, if there is one.
[[nodiscard]] constexpr std::optional<EditGroup> edit_group(std::string_view group_name) {
  for (const EditGroup group : kEditGroups) {
    if (name(group) == group_name) return group;
  }
  return std::nullopt;
}

}  // namespace marey
