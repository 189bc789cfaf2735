// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>

#include "tests/support/bodies/made_body.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::testing {
namespace {

constexpr std::array<const char*, 5> kSchemes{
    "mixamo", "unreal", "vrm", "blender", "cmu"};

}  // namespace

std::string made_bone_name(int scheme, HumanBone bone) {
  const std::string vrm(name(bone));
  const bool left = vrm.starts_with("left");
  const bool right = vrm.starts_with("right");
  const std::string part = left ? vrm.substr(4) : right ? vrm.substr(5) : vrm;
  using Names = std::map<std::string, std::string>;
  static const Names kMixamo{{"hips", "Hips"},
                             {"neck", "Neck"},
                             {"head", "Head"},
                             {"Shoulder", "Shoulder"},
                             {"UpperArm", "Arm"},
                             {"LowerArm", "ForeArm"},
                             {"Hand", "Hand"},
                             {"UpperLeg", "UpLeg"},
                             {"LowerLeg", "Leg"},
                             {"Foot", "Foot"},
                             {"Toes", "ToeBase"}};
  static const Names kUnreal{{"hips", "pelvis"},
                             {"neck", "neck_01"},
                             {"head", "head"},
                             {"Shoulder", "clavicle"},
                             {"UpperArm", "upperarm"},
                             {"LowerArm", "lowerarm"},
                             {"Hand", "hand"},
                             {"UpperLeg", "thigh"},
                             {"LowerLeg", "calf"},
                             {"Foot", "foot"},
                             {"Toes", "ball"}};
  static const Names kBlender{{"hips", "hips"},
                              {"neck", "neck"},
                              {"head", "head"},
                              {"Shoulder", "shoulder"},
                              {"UpperArm", "upper_arm"},
                              {"LowerArm", "forearm"},
                              {"Hand", "hand"},
                              {"UpperLeg", "thigh"},
                              {"LowerLeg", "shin"},
                              {"Foot", "foot"},
                              {"Toes", "toe"}};
  const std::string side = left ? "Left" : right ? "Right" : "";
  const std::string letter = left ? "l" : "r";
  switch (scheme) {
    case 0:
      return "mixamorig:" + side + kMixamo.at(part);
    case 1:
      return side.empty() ? kUnreal.at(part) : kUnreal.at(part) + "_" + letter;
    case 3:
      return side.empty() ? kBlender.at(part) : kBlender.at(part) + (left ? ".L" : ".R");
    case 4:
      return side + kMixamo.at(part);
    default:
      return vrm;
  }
}

std::string made_spine_name(int scheme, int i) {
  const std::string number = std::to_string(i);
  switch (scheme) {
    case 0:
      return "mixamorig:Spine" + (i == 0 ? "" : number);
    case 1:
      return "spine_0" + std::to_string(i + 1);
    case 3:
      return i == 0 ? "spine" : "spine.00" + number;
    case 4:
      return i == 0 ? "LowerBack" : i == 1 ? "Spine" : "Spine" + std::to_string(i - 1);
    default:
      return i == 0   ? "spine"
             : i == 1 ? "chest"
             : i == 2 ? "upperChest"
                      : "spine" + number;
  }
}

MadeBodyRule made_body_rule(std::uint64_t seed) {
  Dice dice(seed * 7919 + 13);
  const auto one_in = [&](double n) { return dice.between(0.0, n) < 1.0; };
  MadeBodyRule rule;
  rule.seed = seed;
  rule.stature_m = dice.between(0.6, 2.5);
  rule.legs = dice.between(0.75, 1.2);
  rule.trunk = dice.between(0.85, 1.2);
  rule.arms = dice.between(0.8, 1.2);
  rule.head = one_in(4.0) ? dice.between(1.5, 3.0) : dice.between(0.8, 1.2);
  rule.thick = dice.between(0.7, 1.6);
  rule.shoes = dice.between(0.8, 1.6);
  rule.naming = static_cast<int>(dice.between(0.0, 4.999));
  const double rest = dice.between(0.0, 3.0);
  rule.arms_down_deg = rest < 1.0 ? 0.0 : rest < 2.0 ? 45.0 : dice.between(55.0, 80.0);
  rule.knees_deg = rest < 2.0 ? 0.0 : dice.between(0.0, 15.0);
  rule.facing_deg = 90.0 * std::floor(dice.between(0.0, 3.999));
  rule.centimetres = one_in(2.5);
  rule.z_up = one_in(3.0);
  rule.root_scale = one_in(4.0) ? dice.between(0.5, 2.0) : 1.0;
  rule.root_at_floor = one_in(2.0);
  rule.twist_bones = one_in(2.5);
  rule.ik_bones = one_in(3.0);
  rule.fingers = one_in(2.0);
  rule.hair = one_in(3.0);
  rule.spine_bones = static_cast<int>(dice.between(1.0, 5.0));
  rule.random_axes = one_in(2.0);
  rule.two_skins = one_in(2.0);
  rule.byte_weights = one_in(3.0);
  return rule;
}

std::string words(const MadeBodyRule& rule) {
  std::array<char, 160> text{};
  std::snprintf(text.data(),
                text.size(),
                "%.2f m legs %.2f trunk %.2f arms %.2f head %.1f thick %.1f, %s, arms "
                "%.0f knees %.0f, faces %.0f",
                rule.stature_m,
                rule.legs,
                rule.trunk,
                rule.arms,
                rule.head,
                rule.thick,
                kSchemes.at(static_cast<std::size_t>(rule.naming)),
                rule.arms_down_deg,
                rule.knees_deg,
                rule.facing_deg);
  std::string out = text.data();
  const auto add = [&](bool is, const char* word) {
    if (is) out += std::string(", ") + word;
  };
  add(rule.centimetres, "cm");
  add(rule.z_up, "z-up");
  add(rule.root_scale != 1.0, "scaled root");
  add(rule.root_at_floor, "root at floor");
  add(rule.root_at_floor && rule.ik_bones, "IK");
  add(rule.twist_bones, "twist");
  add(rule.hair, "hair");
  add(rule.random_axes, "random axes");
  return out;
}

}  // namespace marey::testing
