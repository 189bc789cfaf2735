// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/adaptation/compare_solvers.h"

#include <algorithm>
#include <utility>

#include "benchmarks/adaptation/posture_measures.h"
#include "core/base/degrees.h"
#include "core/base/quantile.h"

namespace marey {
namespace {

constexpr int kRounds = 5;
constexpr int kRunsPerTask = 5;
constexpr double kReached_m = 1e-3;

/// Times and results of one contender.
struct Record {
  Contender contender;
  std::vector<double> median_us;    // One per round.
  std::vector<double> p95_us;       // One per round.
  std::vector<double> in_a_row_us;  // One per round.
  std::vector<double> iterations;   // One per task, as `found`.
  std::vector<PostureMeasure> found;
};

void time_round(const std::vector<PostureTask>& tasks, Record& record) {
  PostureSolver& solver = *record.contender.solver;
  std::vector<double> best_us;
  for (const PostureTask& task : tasks) {
    solver.load(task);
    double min_us = 1e18;
    for (int run = 0; run < kRunsPerTask; ++run) {
      const double start_us = now_us();
      solver.solve(task);
      min_us = std::min(min_us, now_us() - start_us);
    }
    best_us.push_back(min_us);
  }
  const double start_us = processor_us();
  for (const PostureTask& task : tasks) solver.solve(task);
  record.in_a_row_us.push_back((processor_us() - start_us) /
                               static_cast<double>(tasks.size()));
  record.median_us.push_back(median(best_us));
  record.p95_us.push_back(quantile(best_us, 0.95));
}

void measure_errors(const Contest& contest, Record& record) {
  PostureSolver& solver = *record.contender.solver;
  Pose found;
  for (const PostureTask& task : contest.tasks) {
    solver.load(task);
    record.iterations.push_back(solver.solve(task));
    solver.store(found);
    record.found.push_back(measure_posture(*contest.character,
                                           contest.goals,
                                           task.targets_in_world,
                                           task.com_in_world,
                                           *task.reference,
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

std::vector<TableCell> row_of(const Record& c) {
  const auto point_mm = each(c.found, &PostureMeasure::worst_point_m, 1e3);
  const auto planted_mm = each(c.found, &PostureMeasure::planted_m, 1e3);
  const auto com_mm = each(c.found, &PostureMeasure::com_m, 1e3);
  const auto deviation_deg =
      each(c.found, &PostureMeasure::deviation_rad, kDegreesPerRadian);
  const auto moved_mm = each(c.found, &PostureMeasure::displacement_m, 1e3);
  const auto reached = std::count_if(
      point_mm.begin(), point_mm.end(), [](double mm) { return mm <= 1e3 * kReached_m; });
  return {c.contender.name,
          median(c.median_us),
          median(c.p95_us),
          median(c.in_a_row_us),
          median(c.iterations),
          mean(c.iterations),
          100.0 * static_cast<double>(reached) / static_cast<double>(point_mm.size()),
          median(point_mm),
          quantile(point_mm, 0.95),
          quantile(point_mm, 1.0),
          median(planted_mm),
          quantile(planted_mm, 1.0),
          median(com_mm),
          quantile(com_mm, 1.0),
          median(deviation_deg),
          mean(deviation_deg),
          mean(moved_mm)};
}

}  // namespace

ResultTable compare_solvers(const Contest& contest, std::vector<Contender> contenders) {
  std::vector<Record> records;
  for (Contender& contender : contenders) {
    records.push_back({std::move(contender), {}, {}, {}, {}, {}});
  }
  for (Record& record : records) measure_errors(contest, record);
  for (int round = 0; round < kRounds; ++round) {
    for (Record& record : records) time_round(contest.tasks, record);
  }
  ResultTable table{
      contest.id,
      contest.title + ", " + std::to_string(contest.tasks.size()) + " cases",
      {{"solver"},
       {"us"},
       {"p95 us"},
       {"in a row us"},
       {"iterations", 0},
       {"mean it.", 1},
       {"<= 1 mm %", 1},
       {"error mm"},
       {"p95 mm"},
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
  for (const Record& record : records) table.rows.push_back(row_of(record));
  return table;
}

std::vector<Contender> all_contenders(const PostureProblem& problem) {
  std::vector<Contender> contenders;
  for (const auto& kinds : {baseline_solvers(), marey_solvers()}) {
    for (const SolverKind& kind : kinds) {
      contenders.push_back({kind.name, kind.make(problem)});
    }
  }
  return contenders;
}

}  // namespace marey
