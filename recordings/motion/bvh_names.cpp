// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/motion/bvh_names.h"

#include <array>
#include <set>
#include <string_view>

#include "core/humanoid.h"

namespace marey::recordings {
namespace {

/// HumanIK's names of the bones, in the order of human_bones().
constexpr std::array<std::string_view, kHumanBoneCount> kHumanIkNames{
    "Hips",          "Spine",        "Spine1",       "Spine2",      "Neck",
    "Head",          "LeftShoulder", "LeftArm",      "LeftForeArm", "LeftHand",
    "RightShoulder", "RightArm",     "RightForeArm", "RightHand",   "LeftUpLeg",
    "LeftLeg",       "LeftFoot",     "LeftToeBase",  "RightUpLeg",  "RightLeg",
    "RightFoot",     "RightToeBase"};

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         c == '_';
}

/// Returns Unity's name: VRM's with a capital.
std::string unity_name(HumanBone bone) {
  std::string text(name(bone));
  text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

std::string own_name(const Joint& joint, std::size_t place, BvhNames names) {
  std::string text = joint.name;
  for (char& c : text) {
    const bool blank = static_cast<unsigned char>(c) <= ' ';
    if (blank || (names == BvhNames::kHumanIk && !is_plain(c))) c = '_';
  }
  return text.empty() ? "joint" + std::to_string(place) : text;
}

std::string wanted_name(const Joint& joint, std::size_t place, BvhNames names) {
  if (joint.bone && names == BvhNames::kHumanIk) {
    return std::string(kHumanIkNames[index(*joint.bone)]);
  }
  if (joint.bone && names == BvhNames::kUnity) return unity_name(*joint.bone);
  return own_name(joint, place, names);
}

}  // namespace

std::vector<std::string> bvh_names(const Skeleton& skeleton, BvhNames names) {
  std::vector<std::string> out(skeleton.joints.size());
  std::set<std::string> taken;
  for (const bool marked : {true, false}) {
    for (std::size_t i = 0; i < out.size(); ++i) {
      if (skeleton.joints[i].bone.has_value() != marked) continue;
      const std::string wanted = wanted_name(skeleton.joints[i], i, names);
      out[i] = wanted;
      for (int n = 2; !taken.insert(out[i]).second; ++n) {
        out[i] = wanted + "_" + std::to_string(n);
      }
    }
  }
  return out;
}

}  // namespace marey::recordings
