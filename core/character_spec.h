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

/// Source of a human's segment masses when only the total is known.
enum class MassTable {
  kDempster,      ///< Dempster 1955, as in Kulpa 2005, table 5.1; its trunk is uncertain.
  kDeLevaFemale,  ///< de Leva 1996, table 4.
  kDeLevaMale,
  kDeLeva,  ///< The mean of these two.
};

/// A segment of anthropometric tables, by the bone that it begins with.
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

/// The masses of a body: its total, each segment, or the total and some segments. The
/// other segments then keep the table's proportions.
struct MassSpec {
  MassTable table = MassTable::kDeLeva;
  /// nullopt: the sum of the segments if all are given; 70 kg if none is, since the
  /// centre of mass does not depend on the total.
  std::optional<double> total_kg;
  /// By MassSegment::bone; other entries are ignored.
  std::array<std::optional<double>, kHumanBoneCount> segment_kg{};
};

/// Limits of one bone's rotation, as in JointLimit.
struct BoneLimit {
  HumanBone bone{};
  glm::dvec3 min_rad{0.0};
  glm::dvec3 max_rad{0.0};
};

/// A load, before the joint that carries it is known.
struct LoadSpec {
  std::string name;
  BodyPoint point;
  double mass_kg = 0.0;
};

/// Individual properties of a human other than lengths (Kulpa 2005, 4.1).
struct CharacterTraits {
  MassSpec mass;
  bool has_limits = true;         ///< Use anatomical limits; `limits` always apply.
  std::vector<BoneLimit> limits;  ///< They replace a bone's anatomical ones.
  Flexibility flexibility;
  std::vector<LoadSpec> loads;
};

/// Source of a character's lengths. Paths as written: relative to the character's file.
struct AvatarBody {
  std::string path;  ///< File of a skeleton: glTF, VRM, BVH.
};
struct SubjectBody {
  std::string path;  ///< Path of a subject.toml.
};
struct AverageBody {
  double stature_m = 1.75;  ///< Argument of average_proportions().
};
using BodySource = std::variant<AverageBody, AvatarBody, SubjectBody>;

/// A character as its file describes it.
struct CharacterSpec {
  std::string name;
  BodySource body;
  CharacterTraits traits;
};

}  // namespace marey
