// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/body/constraint_words.h"

#include <cmath>

namespace marey::recordings {
namespace {

struct Word {
  std::string_view theirs;
  std::string_view vrm;
};

// Names without their side. Kulpa (2005) shows two of S4DMaker's names: leftForearm
// (figure A.2) and rightSternoClavicular (annex A). The others are usual names of
// segments whose proximal joint is that of VRM's bone.
constexpr std::array<Word, 9> kOfSides{{
    {"SternoClavicular", "Shoulder"},
    {"Clavicle", "Shoulder"},
    {"Arm", "UpperArm"},
    {"Forearm", "LowerArm"},
    {"Thigh", "UpperLeg"},
    {"Shank", "LowerLeg"},
    {"Calf", "LowerLeg"},
    {"Ankle", "Foot"},
    {"Toe", "Toes"},
}};
constexpr std::array<Word, 5> kOfMiddle{{
    {"pelvis", "hips"},
    {"abdomen", "spine"},
    {"thorax", "chest"},
    {"torso", "chest"},
    {"skull", "head"},
}};

}  // namespace

std::string vrm_segment(std::string_view name) {
  for (const std::string_view side : {"left", "right"}) {
    if (!name.starts_with(side)) continue;
    for (const Word& word : kOfSides) {
      if (name.substr(side.size()) == word.theirs)
        return std::string(side).append(word.vrm);
    }
  }
  for (const Word& word : kOfMiddle) {
    if (name == word.theirs) return std::string(word.vrm);
  }
  return std::string(name);
}

glm::dquat normalized_once(const glm::dquat& rotation) {
  // Far above the rounding of a division, far below the rounding by hand.
  constexpr double kUnit = 1e-12;
  const double n = glm::length(rotation);
  return std::abs(n - 1.0) <= kUnit ? rotation : rotation / n;
}

}  // namespace marey::recordings
