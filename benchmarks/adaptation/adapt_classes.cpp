// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// One table per class of cases, without and with the centre of mass.
#include <string>
#include <utility>

#include "benchmarks/adaptation/adapt_questions.h"
#include "benchmarks/adaptation/compare_solvers.h"

namespace marey {
namespace {

struct Class {
  std::string id;
  std::string title;
  std::vector<const AdaptCase*> cases;
};

std::vector<Class> classes_of(const CaseSet& set) {
  std::vector<Class> classes{{"near", "near", {}},
                             {"far", "far", {}},
                             {"unreachable", "unreachable", {}},
                             {"near_limbs", "near, limbs suffice", {}},
                             {"near_trunk", "near, the trunk is needed", {}}};
  for (const AdaptCase& asked : set.cases) {
    classes[static_cast<std::size_t>(asked.kind)].cases.push_back(&asked);
    if (asked.kind != CaseClass::kNear) continue;
    classes[is_for_limbs_alone(set.body, asked) ? 3 : 4].cases.push_back(&asked);
  }
  return classes;
}

PostureTask task_of(const AdaptCase& asked, const Pose& reference) {
  return {&reference, asked.targets_in_world, asked.com_target_in_world};
}

}  // namespace

std::vector<ResultTable> measure_classes(const CaseSet& cases) {
  const Pose reference = rest_pose(cases.body.character.skeleton);
  const auto goals = case_goals(cases.body);
  std::vector<ResultTable> tables;
  for (const bool with_balance : {false, true}) {
    for (const Class& one : classes_of(cases)) {
      if (one.cases.empty()) continue;
      Contest contest{one.id + (with_balance ? "_com" : ""),
                      one.title + (with_balance ? ", centre of mass" : ""),
                      &cases.body.character,
                      goals,
                      {}};
      for (const AdaptCase* asked : one.cases) {
        contest.tasks.push_back(task_of(*asked, reference));
      }
      tables.push_back(compare_solvers(
          contest, all_contenders({&cases.body.character, goals, with_balance})));
      print_table(tables.back());
    }
  }
  return tables;
}

}  // namespace marey
