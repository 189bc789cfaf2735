// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/labels/landmarks.h"

#include <algorithm>
#include <array>
#include <deque>
#include <string>
#include <vector>

#include "core/base/assert.h"

namespace marey::reconstruct {
namespace {

using B = HumanBone;

// clang-format off
/// Landmarks of the left side; the name without "left_".
constexpr std::array kLeft{
    Landmark{"front_head", B::kHead, {0.040, 0.070, 0.046}, 0.012},
    Landmark{"back_head", B::kHead, {0.038, 0.070, -0.044}, 0.014},
    Landmark{"side_head", B::kHead, {0.042, 0.053, 0.010}, 0.012},
    Landmark{"ear", B::kHead, {0.045, 0.025, 0.008}, 0.010},

    Landmark{"clavicle", B::kUpperChest, {0.018, 0.060, 0.036}, 0.014},
    Landmark{"back", B::kUpperChest, {0.055, -0.010, -0.062}, 0.030},
    Landmark{"rib", B::kChest, {0.070, 0.010, 0.040}, 0.028},
    Landmark{"scapula", B::kUpperChest, {0.060, 0.030, -0.062}, 0.030},
    Landmark{"acromion", B::kLeftShoulder, {0.085, 0.031, -0.008}, 0.012},
    Landmark{"acromial_angle", B::kLeftShoulder, {0.092, 0.024, -0.030}, 0.010},
    Landmark{"coracoid", B::kLeftShoulder, {0.070, 0.008, 0.026}, 0.012},
    Landmark{"scapular_spine_root", B::kLeftShoulder, {0.035, 0.005, -0.056}, 0.014},
    Landmark{"inferior_scapular_angle", B::kLeftShoulder, {0.045, -0.060, -0.060}, 0.016},
    Landmark{"shoulder_front", B::kLeftShoulder, {0.090, 0.000, 0.033}, 0.014},
    Landmark{"shoulder_back", B::kLeftShoulder, {0.090, 0.000, -0.036}, 0.014},
    Landmark{"shoulder", B::kLeftShoulder, {0.070, 0.020, -0.010}, 0.030},

    Landmark{"upper_arm", B::kLeftUpperArm, {0.095, 0.022, 0.000}, 0.035},
    Landmark{"lateral_epicondyle_humerus", B::kLeftUpperArm, {0.182, 0.025, 0.000}, 0.009},
    Landmark{"medial_epicondyle_humerus", B::kLeftUpperArm, {0.182, -0.027, -0.002}, 0.009},
    Landmark{"olecranon", B::kLeftLowerArm, {0.000, 0.000, -0.025}, 0.010},
    Landmark{"forearm", B::kLeftLowerArm, {0.070, 0.016, 0.000}, 0.035},
    Landmark{"radial_styloid", B::kLeftLowerArm, {0.142, 0.002, 0.021}, 0.010},
    Landmark{"ulnar_styloid", B::kLeftLowerArm, {0.141, 0.005, -0.020}, 0.010},
    Landmark{"wrist_thumb_side", B::kLeftLowerArm, {0.142, 0.006, 0.034}, 0.016},
    Landmark{"wrist_little_finger_side", B::kLeftLowerArm, {0.142, 0.006, -0.034}, 0.016},
    Landmark{"wrist", B::kLeftLowerArm, {0.143, 0.018, 0.000}, 0.012},
    Landmark{"metacarpal_1_head", B::kLeftHand, {0.026, 0.004, 0.030}, 0.014},
    Landmark{"metacarpal_2_head", B::kLeftHand, {0.049, 0.013, 0.018}, 0.012},
    Landmark{"metacarpal_3_head", B::kLeftHand, {0.050, 0.014, 0.002}, 0.010},
    Landmark{"metacarpal_5_head", B::kLeftHand, {0.042, 0.011, -0.023}, 0.012},
    Landmark{"thumb", B::kLeftHand, {0.040, 0.000, 0.038}, 0.028},
    Landmark{"hand", B::kLeftHand, {0.040, 0.014, 0.002}, 0.030},

    Landmark{"asis", B::kHips, {0.070, 0.037, 0.045}, 0.011},
    Landmark{"psis", B::kHips, {0.027, 0.058, -0.056}, 0.011},
    Landmark{"iliac_crest", B::kHips, {0.087, 0.075, 0.003}, 0.014},
    Landmark{"waist_front", B::kHips, {0.070, 0.045, 0.048}, 0.020},
    Landmark{"waist_back", B::kHips, {0.036, 0.060, -0.056}, 0.022},
    Landmark{"waist_side", B::kHips, {0.090, 0.060, 0.000}, 0.025},
    Landmark{"greater_trochanter", B::kLeftUpperLeg, {0.044, -0.008, -0.006}, 0.012},
    Landmark{"thigh", B::kLeftUpperLeg, {0.035, -0.140, 0.020}, 0.045},
    Landmark{"suprapatella", B::kLeftUpperLeg, {0.002, -0.218, 0.041}, 0.012},
    Landmark{"patella", B::kLeftUpperLeg, {0.002, -0.240, 0.041}, 0.012},
    Landmark{"lateral_epicondyle_femur", B::kLeftUpperLeg, {0.034, -0.243, 0.000}, 0.009},
    Landmark{"medial_epicondyle_femur", B::kLeftUpperLeg, {-0.034, -0.244, 0.000}, 0.009},

    Landmark{"lateral_tibial_condyle", B::kLeftLowerLeg, {0.031, -0.013, 0.004}, 0.010},
    Landmark{"medial_tibial_condyle", B::kLeftLowerLeg, {-0.031, -0.013, 0.004}, 0.010},
    Landmark{"fibula_head", B::kLeftLowerLeg, {0.032, -0.034, -0.009}, 0.010},
    Landmark{"tibial_tuberosity", B::kLeftLowerLeg, {0.003, -0.046, 0.029}, 0.012},
    Landmark{"shank", B::kLeftLowerLeg, {0.020, -0.120, 0.010}, 0.040},
    Landmark{"lateral_malleolus", B::kLeftLowerLeg, {0.026, -0.248, -0.005}, 0.008},
    Landmark{"medial_malleolus", B::kLeftLowerLeg, {-0.025, -0.243, 0.004}, 0.008},

    Landmark{"heel", B::kLeftFoot, {0.000, -0.020, -0.040}, 0.010},
    Landmark{"lateral_calcaneus", B::kLeftFoot, {0.021, -0.022, -0.012}, 0.012},
    Landmark{"medial_calcaneus", B::kLeftFoot, {-0.021, -0.020, -0.010}, 0.012},
    Landmark{"navicular", B::kLeftFoot, {-0.022, -0.008, 0.028}, 0.012},
    Landmark{"midfoot", B::kLeftFoot, {-0.010, 0.000, 0.045}, 0.018},
    Landmark{"lateral_midfoot", B::kLeftFoot, {0.028, -0.018, 0.035}, 0.016},
    Landmark{"metatarsal_1_base", B::kLeftFoot, {-0.019, -0.003, 0.049}, 0.014},
    Landmark{"metatarsal_5_base", B::kLeftFoot, {0.027, -0.024, 0.024}, 0.012},
    Landmark{"metatarsal_1_head", B::kLeftFoot, {-0.022, -0.020, 0.082}, 0.012},
    Landmark{"metatarsal_2_head", B::kLeftFoot, {0.000, -0.015, 0.082}, 0.014},
    Landmark{"metatarsal_3_head", B::kLeftFoot, {0.010, -0.017, 0.079}, 0.012},
    Landmark{"metatarsal_5_head", B::kLeftFoot, {0.033, -0.026, 0.067}, 0.012},
    Landmark{"foot", B::kLeftFoot, {0.003, -0.010, 0.045}, 0.035},
    Landmark{"big_toe", B::kLeftToes, {-0.018, 0.005, 0.026}, 0.014},
    Landmark{"toe_tip", B::kLeftToes, {0.000, 0.005, 0.036}, 0.016},
    Landmark{"toes", B::kLeftToes, {0.000, 0.006, 0.020}, 0.030},
};

constexpr std::array kMiddle{
    Landmark{"head_top", B::kHead, {0, 0.120, 0.000}, 0.012},
    Landmark{"forehead", B::kHead, {0, 0.070, 0.066}, 0.012},
    Landmark{"occiput", B::kHead, {0, 0.060, -0.058}, 0.014},
    Landmark{"head", B::kHead, {0, 0.080, 0.000}, 0.045},
    Landmark{"neck", B::kNeck, {0, 0.030, -0.030}, 0.030},
    Landmark{"c7", B::kUpperChest, {0, 0.092, -0.048}, 0.012},
    Landmark{"t2", B::kUpperChest, {0, 0.068, -0.058}, 0.012},
    Landmark{"t4", B::kUpperChest, {0, 0.040, -0.064}, 0.014},
    Landmark{"t6", B::kUpperChest, {0, 0.000, -0.068}, 0.014},
    Landmark{"t8", B::kUpperChest, {0, -0.028, -0.070}, 0.014},
    Landmark{"t10", B::kUpperChest, {0, -0.053, -0.068}, 0.018},
    Landmark{"suprasternal_notch", B::kUpperChest, {0, 0.058, 0.034}, 0.012},
    Landmark{"sternum", B::kUpperChest, {0, -0.004, 0.058}, 0.022},
    Landmark{"xiphoid", B::kUpperChest, {0, -0.038, 0.062}, 0.014},
    Landmark{"upper_chest", B::kUpperChest, {0, 0.020, 0.000}, 0.060},
    Landmark{"t12", B::kChest, {0, 0.005, -0.060}, 0.016},
    Landmark{"chest", B::kChest, {0, 0.040, 0.000}, 0.060},
    Landmark{"l1", B::kSpine, {0, 0.065, -0.056}, 0.018},
    Landmark{"l3", B::kSpine, {0, 0.035, -0.054}, 0.018},
    Landmark{"navel", B::kSpine, {0, 0.025, 0.065}, 0.020},
    Landmark{"spine", B::kSpine, {0, 0.035, -0.040}, 0.040},
    Landmark{"l5", B::kHips, {0, 0.080, -0.054}, 0.014},
    Landmark{"sacrum", B::kHips, {0, 0.056, -0.060}, 0.014},
    Landmark{"hips", B::kHips, {0, 0.050, -0.030}, 0.055},
};
// clang-format on

struct Table {
  std::deque<std::string> names;  ///< Storage of the rows' names.
  std::vector<Landmark> rows;
  std::vector<std::size_t> by_name;
};

Table make_table() {
  Table table;
  for (const Landmark& left : kLeft) {
    table.rows.push_back(left);
    table.rows.back().name = table.names.emplace_back("left_" + std::string(left.name));
  }
  for (const Landmark& left : kLeft) {
    Landmark right = left;
    right.name = table.names.emplace_back("right_" + std::string(left.name));
    right.segment = mirrored(left.segment);
    right.p_in_segment_per_stature.x *= -1.0;
    table.rows.push_back(right);
  }
  table.rows.insert(table.rows.end(), kMiddle.begin(), kMiddle.end());
  for (std::size_t i = 0; i < table.rows.size(); ++i) table.by_name.push_back(i);
  std::sort(
      table.by_name.begin(), table.by_name.end(), [&](std::size_t a, std::size_t b) {
        return table.rows[a].name < table.rows[b].name;
      });
  return table;
}

const Table& the_table() {
  static const Table table = make_table();
  return table;
}

}  // namespace

std::span<const Landmark> landmarks() {
  return the_table().rows;
}

const Landmark* find_landmark(std::string_view name) {
  const Table& table = the_table();
  const auto at = std::lower_bound(table.by_name.begin(),
                                   table.by_name.end(),
                                   name,
                                   [&](std::size_t i, std::string_view wanted) {
                                     return table.rows[i].name < wanted;
                                   });
  if (at == table.by_name.end() || table.rows[*at].name != name) return nullptr;
  return &table.rows[*at];
}

const Landmark& somewhere_on(HumanBone bone) {
  const Landmark* widest = nullptr;
  for (const Landmark& landmark : landmarks()) {
    if (landmark.segment != bone) continue;
    if (widest == nullptr || landmark.sigma_per_stature > widest->sigma_per_stature) {
      widest = &landmark;
    }
  }
  MAREY_ASSERT(widest != nullptr);
  return *widest;
}

}  // namespace marey::reconstruct
