// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// One table per class of cases. Solvers take turns, round by round, so that a processor
// that changes its pace changes it for all. Of each case the fastest of a few runs in a
// round counts, of the cases the median, of the rounds the median.
#include <algorithm>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include "benchmarks/adapt_questions.h"
#include "benchmarks/posture_measures.h"
#include "benchmarks/posture_solver.h"

#include "core/quantile.h"

namespace marey {
namespace {

constexpr int kRounds = 5;
constexpr int kRunsPerCase = 5;
constexpr double kReached_m = 1e-3;
constexpr double kDegrees = 180.0 / std::numbers::pi;

/// What one solver did with one list of cases.
struct Column {
  std::string name;
  std::unique_ptr<PostureSolver> solver;
  std::vector<double> median_us;    // One per round.
  std::vector<double> p95_us;       // One per round.
  std::vector<double> in_a_row_us;  // One per round: all cases, one after the other.
  std::vector<double> iterations;   // From here on one per case.
  std::vector<PostureMeasure> found;
};

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

void time_round(const Class& cases, const Pose& reference, Column& column) {
  std::vector<double> best_us;
  for (const AdaptCase* asked : cases.cases) {
    const PostureTask task = task_of(*asked, reference);
    column.solver->load(task);
    double least_us = 1e18;
    for (int run = 0; run < kRunsPerCase; ++run) {
      const double start_us = now_us();
      column.solver->solve(task);
      least_us = std::min(least_us, now_us() - start_us);
    }
    best_us.push_back(least_us);
  }
  const double start_us = now_us();
  for (const AdaptCase* asked : cases.cases)
    column.solver->solve(task_of(*asked, reference));
  column.in_a_row_us.push_back((now_us() - start_us) /
                               static_cast<double>(cases.cases.size()));
  column.median_us.push_back(median(best_us));
  column.p95_us.push_back(quantile(best_us, 0.95));
}

void judge(const CaseBody& body,
           const Class& cases,
           std::span<const PointGoal> goals,
           const Pose& reference,
           Column& column) {
  Pose found;
  for (const AdaptCase* asked : cases.cases) {
    const PostureTask task = task_of(*asked, reference);
    column.solver->load(task);
    column.iterations.push_back(column.solver->solve(task));
    column.solver->store(found);
    column.found.push_back(measure_posture(body.character,
                                           goals,
                                           task.targets_in_world,
                                           task.com_in_world,
                                           reference,
                                           found));
  }
}

std::vector<double> each(const std::vector<PostureMeasure>& found,
                         double PostureMeasure::*what,
                         double unit) {
  std::vector<double> values;
  for (const PostureMeasure& m : found) values.push_back(unit * m.*what);
  return values;
}

std::vector<TableCell> row_of(const Column& c) {
  const auto point_mm = each(c.found, &PostureMeasure::worst_point_m, 1e3);
  const auto planted_mm = each(c.found, &PostureMeasure::planted_m, 1e3);
  const auto com_mm = each(c.found, &PostureMeasure::com_m, 1e3);
  const auto deviation_deg = each(c.found, &PostureMeasure::deviation_rad, kDegrees);
  const auto moved_mm = each(c.found, &PostureMeasure::displacement_m, 1e3);
  const auto reached = std::count_if(
      point_mm.begin(), point_mm.end(), [](double mm) { return mm <= 1e3 * kReached_m; });
  return {c.name,
          median(c.median_us),
          median(c.p95_us),
          median(c.in_a_row_us),
          median(c.iterations),
          mean(c.iterations),
          100.0 * static_cast<double>(reached) / static_cast<double>(point_mm.size()),
          median(point_mm),
          quantile(point_mm, 1.0),
          median(planted_mm),
          quantile(planted_mm, 1.0),
          median(com_mm),
          quantile(com_mm, 1.0),
          median(deviation_deg),
          mean(deviation_deg),
          mean(moved_mm)};
}

ResultTable measure_class(const CaseSet& set, const Class& cases, bool with_balance) {
  const Pose reference = rest_pose(set.body.character.skeleton);
  const PostureProblem problem{&set.body.character, case_goals(set.body), with_balance};
  std::vector<Column> columns;
  auto kinds = baseline_solvers();
  for (SolverKind& kind : marey_solvers()) kinds.push_back(std::move(kind));
  for (const SolverKind& kind : kinds) {
    columns.push_back({kind.name, kind.make(problem), {}, {}, {}, {}, {}});
  }
  for (Column& c : columns) judge(set.body, cases, problem.goals, reference, c);
  for (int round = 0; round < kRounds; ++round) {
    for (Column& c : columns) time_round(cases, reference, c);
  }
  ResultTable table{cases.id + (with_balance ? "_com" : ""),
                    cases.title + (with_balance ? ", centre of mass" : "") + ", " +
                        std::to_string(cases.cases.size()) + " cases",
                    {{"solver"},
                     {"us"},
                     {"p95 us"},
                     {"in a row us"},
                     {"iterations", 0},
                     {"mean it.", 1},
                     {"<= 1 mm %", 1},
                     {"error mm"},
                     {"worst mm"},
                     {"foot mm", 3},
                     {"worst foot mm", 3},
                     {"COM mm"},
                     {"worst COM mm"},
                     {"deviation deg"},
                     {"mean dev. deg"},
                     {"moved mm", 1}},
                    {},
                    {}};
  for (const Column& c : columns) table.rows.push_back(row_of(c));
  return table;
}

}  // namespace

std::vector<ResultTable> measure_classes(const CaseSet& cases) {
  std::vector<ResultTable> tables;
  const auto classes = classes_of(cases);
  for (const bool with_balance : {false, true}) {
    for (const Class& one : classes) {
      if (one.cases.empty()) continue;
      tables.push_back(measure_class(cases, one, with_balance));
      print_table(tables.back());
    }
  }
  return tables;
}

}  // namespace marey
