// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/adaptation/adapt_cases.h"

#include <cmath>
#include <fstream>
#include <string_view>
#include <utility>

#include <glm/geometric.hpp>

#include "core/character_spec.h"
#include "core/humanoid.h"
#include "core/transform.h"
#include "retarget/body/body_map.h"
#include "retarget/character/make_character.h"

namespace marey {
namespace {

constexpr double kLimbTolerance_m = 0.005;

/// "UpperArm_L" is VRM's leftUpperArm, "Hips" its hips.
std::optional<HumanBone> bone_of(std::string_view joint_name) {
  std::string word(joint_name);
  const bool is_left = word.ends_with("_L");
  const bool is_right = word.ends_with("_R");
  if (is_left || is_right) {
    word = (is_left ? "left" : "right") + word.substr(0, word.size() - 2);
  } else if (!word.empty()) {
    word[0] = static_cast<char>(word[0] - 'A' + 'a');
  }
  return human_bone(word);
}

std::istream& operator>>(std::istream& in, glm::dvec3& v) {
  return in >> v.x >> v.y >> v.z;
}

Error broken(const std::filesystem::path& file) {
  return bad_input(file.string(),
                   "missing, or its length differs from its first number",
                   "give the folder of model.txt and targets.txt");
}

Result<CaseBody> read_body(const std::filesystem::path& file) {
  std::ifstream in(file);
  CaseBody body;
  Skeleton skeleton;
  std::vector<PointMass> masses;
  int count = 0;
  in >> count;
  for (int i = 0; i < count && in; ++i) {
    Joint joint;
    PointMass mass;
    int parent = 0;
    in >> joint.name >> parent >> joint.parent_from_joint.translation >> mass.mass_kg >>
        mass.p_in_joint;
    if (parent >= i) return broken(file);
    if (parent >= 0) joint.parent = JointIndex{parent};
    joint.bone = bone_of(joint.name);
    mass.joint = JointIndex{i};
    skeleton.joints.push_back(std::move(joint));
    masses.push_back(mass);
  }
  for (JointIndex& point : body.points) {
    int joint = -1;
    in >> joint;
    if (!in || joint < 0 || joint >= count) return broken(file);
    point = JointIndex{joint};
  }
  const auto map = retarget::map_body(skeleton);
  if (!map) return map.error();
  CharacterTraits free;
  free.has_limits = false;
  free.mass.table = MassTable::kDempster;  // As in the thesis, to compare its figures.
  auto character = retarget::make_character("cases", std::move(skeleton), *map, free);
  if (!character) return character.error();
  body.character = *std::move(character);
  body.character.masses = std::move(masses);
  return body;
}

}  // namespace

std::vector<PointGoal> case_goals(const CaseBody& body) {
  std::vector<PointGoal> goals;
  for (std::size_t k = 0; k < kCasePoints; ++k) {
    goals.push_back({body.points[k], k == kPlantedPoint});
  }
  return goals;
}

Result<CaseSet> read_cases(const std::filesystem::path& folder) {
  auto body = read_body(folder / "model.txt");
  if (!body) return body.error();
  CaseSet set{*std::move(body), {}};
  std::ifstream in(folder / "targets.txt");
  std::size_t count = 0;
  in >> count;
  for (std::size_t i = 0; i < count && in; ++i) {
    AdaptCase asked;
    int kind = 0;
    in >> kind;
    asked.kind = static_cast<CaseClass>(kind);
    for (glm::dvec3& target : asked.targets_in_world) in >> target;
    in >> asked.com_target_in_world;
    set.cases.push_back(asked);
  }
  if (!in || set.cases.empty()) return broken(folder / "targets.txt");
  return set;
}

bool is_for_limbs_alone(const CaseBody& body, const AdaptCase& asked) {
  const Skeleton& skeleton = body.character.skeleton;
  const auto world_from_joint = world_from_joints(skeleton, rest_pose(skeleton));
  for (std::size_t k = 0; k < kCasePoints; ++k) {
    const Joint& end = skeleton[body.points[k]];
    const Joint& lower = skeleton[*end.parent];
    const double upper_m = glm::length(lower.parent_from_joint.translation);
    const double lower_m = glm::length(end.parent_from_joint.translation);
    const glm::dvec3 root_in_world = world_from_joint[index(*lower.parent)].translation;
    const double wanted_m = glm::distance(root_in_world, asked.targets_in_world[k]);
    if (wanted_m > upper_m + lower_m + kLimbTolerance_m ||
        wanted_m < std::abs(upper_m - lower_m) - kLimbTolerance_m) {
      return false;
    }
  }
  return true;
}

}  // namespace marey
