// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Is an adapted posture one that a person would take (Kulpa 2005, 5.4)? A captured
// posture is adapted to where wrists and ankles are in another of the same clip, further
// out; how far are its joints from where they really were?
#include <memory>
#include <string>
#include <utility>

#include "benchmarks/adaptation/adapt_questions.h"
#include "benchmarks/adaptation/posture_measures.h"
#include "benchmarks/adaptation/posture_solver.h"
#include "benchmarks/parts/captured_clips.h"
#include "core/base/quantile.h"
#include "core/transform.h"

namespace marey {
namespace {

constexpr std::size_t kMaxPairs = 12;

/// Target of the centre of mass.
enum class Balance { kOff, kAsReference, kAsCaptured };

struct Question {
  Balance balance = Balance::kOff;
  std::string id;
  std::string title;
};

std::vector<PointGoal> goals_of(const Skeleton& skeleton, const CapturedPair& pair) {
  return {{*skeleton.find(HumanBone::kRightHand), false},
          {*skeleton.find(HumanBone::kLeftHand), false},
          {*skeleton.find(HumanBone::kRightFoot), pair.right_stands},
          {*skeleton.find(HumanBone::kLeftFoot), pair.left_stands}};
}

/// Mean joint distances of each pair: without adaptation, then by solver.
using Distances = std::vector<std::vector<double>>;

Distances measure_clip(const CapturedClip& clip,
                       const std::vector<SolverKind>& kinds,
                       Balance balance) {
  const Skeleton& skeleton = clip.character.skeleton;
  Distances distances_mm(kinds.size() + 1);
  for (const CapturedPair& pair : choose_pairs(clip, kMaxPairs)) {
    const Pose& near = clip.poses[pair.near_frame];
    const Pose& far = clip.poses[pair.far_frame];
    const auto world_from_far = world_from_joints(skeleton, far);
    const auto goals = goals_of(skeleton, pair);
    std::vector<glm::dvec3> targets_in_world;
    for (const PointGoal& goal : goals) {
      targets_in_world.push_back(world_from_far[index(goal.joint)].translation);
    }
    const Pose& balanced = balance == Balance::kAsCaptured ? far : near;
    const PostureTask task{
        &near, targets_in_world, centre_of_mass(clip.character, balanced)};
    distances_mm[0].push_back(1e3 * mean_joint_distance_m(skeleton, near, far));
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      const auto solver =
          kinds[k].make({&clip.character, goals, balance != Balance::kOff});
      Pose found;
      solver->load(task);
      solver->solve(task);
      solver->store(found);
      distances_mm[k + 1].push_back(1e3 * mean_joint_distance_m(skeleton, found, far));
    }
  }
  return distances_mm;
}

std::vector<TableCell> row_of(const std::string& name, const Distances& distances_mm) {
  std::vector<TableCell> row{name, static_cast<double>(distances_mm[0].size())};
  for (const auto& column : distances_mm) row.emplace_back(mean(column));
  return row;
}

ResultTable compare(const std::vector<CapturedClip>& clips, const Question& question) {
  ResultTable table{
      question.id,
      question.title,
      {{"clip"}, {"pairs", 0}, {"not adapted", 1}},
      {},
      {"Pairs and supports are chosen by rule: benchmarks/parts/captured_clips.h."}};
  auto kinds = baseline_solvers();
  for (SolverKind& kind : marey_solvers()) kinds.push_back(std::move(kind));
  for (const SolverKind& kind : kinds) table.columns.push_back({kind.name, 1});
  Distances all_mm(kinds.size() + 1);
  for (const CapturedClip& clip : clips) {
    const Distances distances_mm = measure_clip(clip, kinds, question.balance);
    if (distances_mm[0].empty()) continue;
    for (std::size_t c = 0; c < all_mm.size(); ++c) {
      all_mm[c].insert(all_mm[c].end(), distances_mm[c].begin(), distances_mm[c].end());
    }
    table.rows.push_back(row_of(clip.name, distances_mm));
  }
  table.rows.push_back(row_of("all", all_mm));
  return table;
}

}  // namespace

std::vector<ResultTable> measure_captured(const std::vector<CapturedClip>& clips) {
  const std::string what =
      "mean distance of joints from the captured far posture, mean of the pairs, mm";
  std::vector<ResultTable> tables;
  for (const Question& question :
       {Question{Balance::kOff, "captured", what},
        Question{Balance::kAsReference,
                 "captured_com",
                 what + "; the centre of mass kept where the near posture has it"},
        Question{Balance::kAsCaptured,
                 "captured_com_known",
                 what + "; the centre of mass where the far posture has it"}}) {
    tables.push_back(compare(clips, question));
    print_table(tables.back());
  }
  return tables;
}

}  // namespace marey
