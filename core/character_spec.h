// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <glm/vec3.hpp>

#include "core/character.h"
#include "core/constraint.h"
#include "core/humanoid.h"

namespace marey {

/// Where a human's masses come from when only the total is known.
enum class MassTable {
  kDempster,  ///< Dempster 1955, as in Kulpa 2005, table 5.1: a trunk that is doubtful.
  kDeLevaFemale,  ///< de Leva 1996, table 4.
  kDeLevaMale,
  kDeLeva,  ///< The mean of these two.
};

/// A segment that anthropometric tables know, by the bone that it begins with.
struct MassSegment {
  HumanBone bone{};
  std::string_view name;  ///< VRM's, but "trunk" for all between hips and neck.
};

inline constexpr std::array<MassSegment, 14> kMassSegments{{
    {HumanBone::kHead, "head"},
    {HumanBone::kHips, "trunk"},
    {HumanBone::kLeftUpperArm, "leftUpperArm"},
    {HumanBone::kLeftLowerArm, "leftLowerArm"},
    {HumanBone::kLeftHand, "leftHand"},
    {HumanBone::kRightUpperArm, "rightUpperArm"},
    {HumanBone::kRightLowerArm, "rightLowerArm"},
    {HumanBone::kRightHand, "rightHand"},
    {HumanBone::kLeftUpperLeg, "leftUpperLeg"},
    {HumanBone::kLeftLowerLeg, "leftLowerLeg"},
    {HumanBone::kLeftFoot, "leftFoot"},
    {HumanBone::kRightUpperLeg, "rightUpperLeg"},
    {HumanBone::kRightLowerLeg, "rightLowerLeg"},
    {HumanBone::kRightFoot, "rightFoot"},
}};

/// What a body weighs: its total, each segment, or the total and some segments, whose
/// rest then keeps the table's proportions.
struct MassSpec {
  MassTable table = MassTable::kDeLeva;
  /// nullopt: the sum of the segments when all are given; 70 kg when none is, which says
  /// where the centre of mass is as well as any.
  std::optional<double> total_kg;
  /// By MassSegment::bone; others are not looked at.
  std::array<std::optional<double>, kHumanBoneCount> segment_kg{};
};

/// How far one bone turns, as JointLimit.
struct BoneLimit {
  HumanBone bone{};
  glm::dvec3 min_rad{0.0};
  glm::dvec3 max_rad{0.0};
};

/// A load, before it is known which joint carries it.
struct LoadSpec {
  std::string name;
  BodyPoint point;
  double mass_kg = 0.0;
};

/// What is a human's own beside lengths (Kulpa 2005, 4.1).
struct CharacterTraits {
  MassSpec mass;
  bool has_limits = true;         ///< The anatomical ones; `limits` hold anyhow.
  std::vector<BoneLimit> limits;  ///< In place of a bone's anatomical ones.
  Flexibility flexibility;
  std::vector<LoadSpec> loads;
};

/// Whose lengths a character has. Paths as written: relative to the character's file.
struct AvatarBody {
  std::string path;  ///< Of a skeleton: glTF, VRM, BVH.
};
struct SubjectBody {
  std::string path;  ///< Of a subject.toml.
};
struct AverageBody {
  double stature_m = 1.75;  ///< average_proportions() of it.
};
using BodySource = std::variant<AverageBody, AvatarBody, SubjectBody>;

/// A character as its file describes it.
struct CharacterSpec {
  std::string name;
  BodySource body;
  CharacterTraits traits;
};

}  // namespace marey
