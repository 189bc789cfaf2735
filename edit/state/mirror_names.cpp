// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/state/mirror_names.h"

#include <array>
#include <cstddef>
#include <optional>
#include <utility>

#include "core/humanoid.h"

namespace marey::edit {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kSideWords{
    {{"left", "right"}, {"Left", "Right"}, {"LEFT", "RIGHT"}}};

bool is_separator(char c) {
  return c == '.' || c == '_' || c == '-' || c == ':' || c == ' ';
}

bool stands_alone(std::string_view name, std::size_t place) {
  const bool free_before = place == 0 || is_separator(name[place - 1]);
  const bool free_after = place + 1 == name.size() || is_separator(name[place + 1]);
  return free_before && free_after && name.size() > 1;
}

std::string replaced(std::string_view name,
                     std::size_t place,
                     std::size_t length,
                     std::string_view by) {
  return std::string(name.substr(0, place)) + std::string(by) +
         std::string(name.substr(place + length));
}

}  // namespace

char other_side_letter(char c) {
  switch (c) {
    case 'L':
      return 'R';
    case 'R':
      return 'L';
    case 'l':
      return 'r';
    case 'r':
      return 'l';
    default:
      return c;
  }
}

std::string mirrored_name(std::string_view name) {
  for (const auto& [left, right] : kSideWords) {
    const std::size_t at_left = name.find(left);
    const std::size_t at_right = name.find(right);
    if (at_left < at_right) return replaced(name, at_left, left.size(), right);
    if (at_right < at_left) return replaced(name, at_right, right.size(), left);
  }
  for (std::size_t i = 0; i < name.size(); ++i) {
    const char other = other_side_letter(name[i]);
    if (other == name[i] || !stands_alone(name, i)) continue;
    return replaced(name, i, 1, std::string_view(&other, 1));
  }
  return std::string(name);
}

std::vector<JointIndex> mirrored_joints(const Skeleton& skeleton) {
  std::vector<JointIndex> out;
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    const Joint& joint = skeleton.joints[j];
    std::optional<JointIndex> other;
    if (joint.bone) {
      other = skeleton.find(mirrored(*joint.bone));
    } else {
      const std::string name = mirrored_name(joint.name);
      if (name != joint.name) other = skeleton.find(std::string_view(name));
      if (other && skeleton[*other].bone) other.reset();
    }
    out.push_back(other.value_or(JointIndex{static_cast<int>(j)}));
  }
  // Names can be ambiguous.
  for (std::size_t j = 0; j < out.size(); ++j) {
    if (index(out[index(out[j])]) != j) out[j] = JointIndex{static_cast<int>(j)};
  }
  return out;
}

}  // namespace marey::edit
