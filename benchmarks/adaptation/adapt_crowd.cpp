// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// A thousand bodies, no two alike, one posture each: four of five with near targets, the
// rest with far ones. Everything counts from a Pose to a Pose.
#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include "benchmarks/adaptation/adapt_questions.h"
#include "benchmarks/adaptation/crowd_movers.h"
#include "benchmarks/adaptation/posture_measures.h"
#include "core/base/quantile.h"
#include "core/transform.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey {
namespace {

constexpr std::size_t kBodies = 1000;
constexpr std::uint64_t kSeed = 2005;
constexpr int kRounds = 7;
constexpr double kTick_us = 40000.0;  // 25 Hz.

/// Lengths of a body divided by those of the cases' body: arms, legs, trunk, whole.
struct Build {
  double arms = 1.0;
  double legs = 1.0;
  double trunk = 1.0;
  double size = 1.0;
};

double factor_of(const Build& build, const Joint& joint) {
  if (!joint.bone) return build.size;
  switch (*joint.bone) {
    case HumanBone::kLeftLowerArm:
    case HumanBone::kRightLowerArm:
    case HumanBone::kLeftHand:
    case HumanBone::kRightHand:
      return build.size * build.arms;
    case HumanBone::kLeftLowerLeg:
    case HumanBone::kRightLowerLeg:
    case HumanBone::kLeftFoot:
    case HumanBone::kRightFoot:
      return build.size * build.legs;
    case HumanBone::kSpine:
    case HumanBone::kChest:
    case HumanBone::kNeck:
      return build.size * build.trunk;
    default:
      return build.size;
  }
}

/// The cases' body in another build; its planted foot where the scaled body's is.
CaseBody built(const CaseBody& body, const Build& build) {
  CaseBody out = body;
  Skeleton& skeleton = out.character.skeleton;
  for (Joint& joint : skeleton.joints) {
    joint.parent_from_joint.translation *= factor_of(build, joint);
  }
  for (PointMass& m : out.character.masses) m.p_in_joint *= build.size;
  const auto ankle = [](const CaseBody& of) {
    const Skeleton& s = of.character.skeleton;
    return world_from_joints(s, rest_pose(s))[index(of.points[kPlantedPoint])]
        .translation;
  };
  skeleton.joints[0].parent_from_joint.translation +=
      build.size * ankle(body) - ankle(out);
  return out;
}

/// Targets lie from where the body has its points as the case's lie from the case body's,
/// larger as the body is.
CrowdMember make_member(const CaseBody& body,
                        const AdaptCase& asked,
                        const Build& build) {
  CaseBody own = built(body, build);
  CrowdMember member;
  member.kind = asked.kind;
  member.reference = rest_pose(own.character.skeleton);
  const Pose model = rest_pose(body.character.skeleton);
  const auto world_from_own = world_from_joints(own.character.skeleton, member.reference);
  const auto world_from_model = world_from_joints(body.character.skeleton, model);
  for (std::size_t k = 0; k < kCasePoints; ++k) {
    const std::size_t joint = index(body.points[k]);
    member.targets_in_world[k] =
        world_from_own[joint].translation +
        build.size * (asked.targets_in_world[k] - world_from_model[joint].translation);
  }
  member.com_in_world =
      centre_of_mass(own.character, member.reference) +
      build.size * (asked.com_target_in_world - centre_of_mass(body.character, model));
  member.character = std::move(own.character);
  return member;
}

std::vector<CrowdMember> make_crowd(const CaseSet& set) {
  std::vector<const AdaptCase*> by_class[2];
  for (const AdaptCase& asked : set.cases) {
    if (asked.kind == CaseClass::kNear) by_class[0].push_back(&asked);
    if (asked.kind == CaseClass::kFar) by_class[1].push_back(&asked);
  }
  testing::Dice dice(kSeed);
  std::vector<CrowdMember> crowd;
  for (std::size_t i = 0; i < kBodies; ++i) {
    const Build build{dice.between(0.85, 1.15),
                      dice.between(0.85, 1.15),
                      dice.between(0.85, 1.15),
                      dice.between(0.7, 1.2)};
    const auto& cases = by_class[i % 5 == 4 ? 1 : 0];
    crowd.push_back(make_member(set.body, *cases[i % cases.size()], build));
  }
  return crowd;
}

std::vector<TableCell> row_of(const CrowdColumn& column,
                              const std::vector<CrowdMember>& crowd,
                              const std::vector<PointGoal>& goals) {
  std::vector<double> point_mm;
  std::vector<double> com_mm;
  double worst_foot_mm = 0.0;
  std::array<double, 2> reached{};
  std::array<double, 2> count{};
  for (std::size_t i = 0; i < crowd.size(); ++i) {
    const CrowdMember& member = crowd[i];
    const PostureMeasure m = measure_posture(member.character,
                                             goals,
                                             member.targets_in_world,
                                             member.com_in_world,
                                             member.reference,
                                             column.found[i]);
    point_mm.push_back(1e3 * m.worst_point_m);
    com_mm.push_back(1e3 * m.com_m);
    worst_foot_mm = std::max(worst_foot_mm, 1e3 * m.planted_m);
    const std::size_t kind = member.kind == CaseClass::kNear ? 0 : 1;
    count[kind] += 1.0;
    if (m.worst_point_m <= 1e-3) reached[kind] += 1.0;
  }
  const double us = median(column.us_each);
  return {column.name,
          us,
          quantile(column.us_each, 0.0),
          kTick_us / us,
          column.KiB_each,
          100.0 * reached[0] / count[0],
          100.0 * reached[1] / count[1],
          median(point_mm),
          quantile(point_mm, 1.0),
          worst_foot_mm,
          median(com_mm),
          quantile(com_mm, 1.0)};
}

ResultTable move_crowd(const std::vector<CrowdMember>& crowd,
                       const CaseSet& set,
                       bool with_balance) {
  const auto goals = case_goals(set.body);
  std::vector<CrowdColumn> columns = crowd_columns(crowd, goals, with_balance);
  for (CrowdColumn& c : columns) c.mover->move(crowd, c.found);
  for (int round = 0; round < kRounds; ++round) {
    for (CrowdColumn& c : columns) {
      const auto clock_us = c.has_threads ? now_us : processor_us;
      const double start_us = clock_us();
      c.mover->move(crowd, c.found);
      c.us_each.push_back((clock_us() - start_us) / static_cast<double>(crowd.size()));
    }
  }
  ResultTable table{with_balance ? "crowd_com" : "crowd",
                    "crowd of " + std::to_string(crowd.size()) +
                        " bodies, 80 % near, 20 % far" +
                        (with_balance ? ", centre of mass" : ""),
                    {{"solver"},
                     {"us each"},
                     {"best us"},
                     {"characters at 25 Hz", 0},
                     {"KiB each", 1},
                     {"near <= 1 mm %", 1},
                     {"far <= 1 mm %", 1},
                     {"error mm"},
                     {"worst mm"},
                     {"worst foot mm", 3},
                     {"COM mm"},
                     {"worst COM mm"}},
                    {},
                    {}};
  for (const CrowdColumn& c : columns) table.rows.push_back(row_of(c, crowd, goals));
  return table;
}

}  // namespace

std::vector<ResultTable> measure_crowd(const CaseSet& cases) {
  const auto crowd = make_crowd(cases);
  std::vector<ResultTable> tables;
  for (const bool with_balance : {false, true}) {
    tables.push_back(move_crowd(crowd, cases, with_balance));
    print_table(tables.back());
  }
  return tables;
}

}  // namespace marey
