// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The tables of the thesis (Kulpa 2005, 4.3 and 5.4), measured in a Pentium 4 of 2.8 GHz,
// and the same rows here. Its scenes are not published: ours is another, of the same
// kind.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>

#include "benchmarks/adaptation/adapt_questions.h"
#include "benchmarks/adaptation/marey_posture_solver.h"
#include "benchmarks/adaptation/posture_measures.h"
#include "benchmarks/adaptation/posture_solver.h"
#include "benchmarks/adaptation/standing_scene.h"
#include "core/base/quantile.h"

namespace marey {
namespace {

using retarget::AdaptOptions;
using retarget::Method;

constexpr int kRuns = 301;
constexpr int kMaxIterations = 100;
constexpr double kTick_us = 40000.0;  // 25 Hz.

/// A row as it is printed there. The first two are CmThreshold and the constraints'
/// precision in chapter 4, CnThreshold and CnErrorMax in chapter 5.
struct PrintedRow {
  double threshold_mm;
  double precision_mm;
  double iterations;
  double us;
  double error_mm;
  double characters;
};

struct PrintedTable {
  std::string id;
  std::string title;
  bool is_balance = false;  // Chapter 5: the error is that of the centre of mass.
  bool above_best = false;  // The error is relative to the least of all solvers.
  StandingScene::Targets StandingScene::*targets;
  std::vector<PrintedRow> rows;
};

std::vector<PrintedTable> printed_tables() {
  return {{"thesis_4_1",
           "table 4.1, near",
           false,
           false,
           &StandingScene::near,
           {{0.01, 1, 2, 88, 0, 454},
            {0.1, 1, 2, 88, 0, 454},
            {1, 1, 2, 88, 0, 454},
            {10, 1, 2, 88, 0, 454},
            {0.01, 10, 2, 88, 0, 454},
            {0.01, 100, 2, 88, 0, 454}}},
          {"thesis_4_2",
           "table 4.2, far",
           false,
           false,
           &StandingScene::far,
           {{0.01, 1, 12, 544, 2, 73},
            {0.1, 1, 12, 548, 2, 73},
            {1, 1, 11, 515, 2, 77},
            {10, 1, 4, 228, 20, 175},
            {0.01, 10, 10, 440, 5, 90},
            {0.01, 100, 3, 117, 43, 341}}},
          {"thesis_4_3",
           "table 4.3, unreachable; errors above the least",
           false,
           true,
           &StandingScene::unreachable,
           {{0.01, 1, 48, 2258, 0, 17},
            {0.1, 1, 48, 2345, 0, 17},
            {1, 1, 24, 1240, 9, 32},
            {10, 1, 8, 443, 48, 90},
            {0.01, 10, 48, 2262, 0, 17},
            {0.01, 100, 11, 537, 42, 74}}},
          {"thesis_5_2",
           "table 5.2, near, centre of mass",
           true,
           false,
           &StandingScene::near,
           {{0.01, 1, 5, 284, 0.26, 140},
            {0.1, 1, 5, 284, 0.26, 140},
            {1, 1, 5, 284, 0.26, 140},
            {10, 1, 5, 284, 0.26, 140},
            {0.01, 10, 3, 188, 7.9, 212},
            {0.01, 100, 2, 141, 57, 283}}},
          {"thesis_5_3",
           "table 5.3, unreachable, centre of mass",
           true,
           false,
           &StandingScene::unreachable,
           {{0.01, 1, 22, 1701, 0, 23},
            {0.1, 1, 22, 1707, 0, 23},
            {1, 1, 14, 1131, 0.07, 35},
            {10, 1, 14, 1135, 0.07, 35},
            {0.01, 10, 19, 1474, 2, 27},
            {0.01, 100, 20, 1524, 89, 26}}}};
}

struct Outcome {
  double iterations = 0.0;
  double us = 0.0;
  PostureMeasure measure;
};

class ThesisScene {
 public:
  ThesisScene(const ThesisScene&) = delete;
  ThesisScene& operator=(const ThesisScene&) = delete;
  explicit ThesisScene(const PrintedTable& table)
      : scene_(standing_scene()),
        targets_(scene_.*table.targets),
        task_{&scene_.reference, targets_, scene_.com_in_world},
        problem_{&scene_.character, scene_.goals, table.is_balance} {}

  [[nodiscard]] Outcome run(PostureSolver& solver, int runs) const {
    Outcome out;
    std::vector<double> us;
    for (int r = 0; r < runs; ++r) {
      solver.load(task_);
      const double start_us = now_us();
      out.iterations = solver.solve(task_);
      us.push_back(now_us() - start_us);
    }
    out.us = median(us);
    Pose found;
    solver.store(found);
    out.measure = measure_posture(scene_.character,
                                  scene_.goals,
                                  targets_,
                                  scene_.com_in_world,
                                  scene_.reference,
                                  found);
    return out;
  }

  [[nodiscard]] Outcome run(const AdaptOptions& options, double precision_m) const {
    return run(*make_marey_solver(problem_, options, precision_m), kRuns);
  }

  [[nodiscard]] Outcome run(const SolverKind& kind) const {
    return run(*kind.make(problem_), kRuns);
  }

 private:
  StandingScene scene_;
  StandingScene::Targets targets_;
  PostureTask task_;  // Looks at the two above.
  PostureProblem problem_;
};

AdaptOptions options_of(const PrintedTable& table, const PrintedRow& row, Method method) {
  AdaptOptions options;
  options.method = method;
  options.max_iterations = kMaxIterations;
  if (table.is_balance) {
    options.constraint_threshold_m = 1e-3;
    options.balance_threshold_m = 1e-3 * row.threshold_mm;
    options.balance_precision_m = 1e-3 * row.precision_mm;
  } else {
    options.constraint_threshold_m = 1e-3 * row.threshold_mm;
  }
  return options;
}

double error_mm(const PrintedTable& table, const PostureMeasure& m) {
  return 1e3 * (table.is_balance ? m.com_m : m.mean_point_m);
}

/// The least mean error of the constraints that any of the solvers ever comes to.
double min_error_mm(const ThesisScene& scene, const PrintedTable& table) {
  double min_mm = 1e9;
  for (const SolverKind& kind : baseline_solvers()) {
    const PostureMeasure m = scene.run(kind).measure;
    if (m.planted_m < 1e-3) min_mm = std::min(min_mm, error_mm(table, m));
  }
  for (const Method method : {Method::kStrict, Method::kThesis}) {
    AdaptOptions patient;
    patient.method = method;
    patient.max_iterations = 2000;
    patient.constraint_threshold_m = 1e-9;
    min_mm = std::min(min_mm, error_mm(table, scene.run(patient, 1e-6).measure));
  }
  return min_mm;
}

void add_outcome(const PrintedTable& table,
                 const Outcome& out,
                 double min_mm,
                 std::vector<TableCell>& row) {
  row.emplace_back(out.iterations);
  row.emplace_back(out.us);
  row.emplace_back(error_mm(table, out.measure) - min_mm);
  row.emplace_back(kTick_us / out.us);
}

ResultTable reprint(const PrintedTable& printed) {
  ResultTable table{
      printed.id,
      printed.title,
      {{"threshold mm"}, {printed.is_balance ? "COM mm" : "precision mm", 0}},
      {},
      {}};
  for (const std::string who : {"printed", "thesis", "strict"}) {
    table.columns.push_back({who + " it.", 0});
    table.columns.push_back({who + " us", 2});
    table.columns.push_back({who + " mm", 2});
    table.columns.push_back({who + " at 25 Hz", 0});
  }
  const ThesisScene scene(printed);
  const double min_mm = printed.above_best ? min_error_mm(scene, printed) : 0.0;
  if (printed.above_best) {
    table.notes.push_back("The least mean error that any solver came to: " +
                          std::to_string(min_mm) + " mm");
  }
  for (const PrintedRow& p : printed.rows) {
    std::vector<TableCell> row{
        p.threshold_mm, p.precision_mm, p.iterations, p.us, p.error_mm, p.characters};
    for (const Method method : {Method::kThesis, Method::kStrict}) {
      const double precision_m = printed.is_balance ? 1e-3 : 1e-3 * p.precision_mm;
      add_outcome(
          printed, scene.run(options_of(printed, p, method), precision_m), min_mm, row);
    }
    table.rows.push_back(std::move(row));
  }
  for (const SolverKind& kind : baseline_solvers()) {
    const Outcome out = scene.run(kind);
    char note[160];
    std::snprintf(note,
                  sizeof note,
                  "%s: %.0f iterations, %.2f us, error %.2f mm, planted foot %.2f mm off",
                  kind.name.c_str(),
                  out.iterations,
                  out.us,
                  error_mm(printed, out.measure) - min_mm,
                  1e3 * out.measure.planted_m);
    table.notes.emplace_back(note);
  }
  return table;
}

}  // namespace

std::vector<ResultTable> measure_thesis() {
  std::vector<ResultTable> tables;
  for (const PrintedTable& printed : printed_tables()) {
    tables.push_back(reprint(printed));
    print_table(tables.back());
  }
  return tables;
}

}  // namespace marey
