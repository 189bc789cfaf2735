// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Are the constraints that an edit finds in captured motions valid, and can motions be
// adapted to them?
//
//   measure_constraints ../shared/data/mocap [seconds of a piece, default 4]
//
// Reads CMU's and Bandai Namco's clips, cuts them into pieces, and applies to each: the
// detection of supports and touches, the adaptation to them, and the adaptation to one
// more constraint that moves the right hand by 15 cm for half a second. Prints per clip:
// constraints found, contradictions, touches left out as impossible, constraints not met
// after adaptation, the largest error, the drift of feet before and after, the largest
// displacement and the largest acceleration that adaptation adds. Then counts errors and
// findings by cause.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "edit/ops/constrain.h"
#include "edit/state/adapt_state.h"
#include "edit/state/plant_feet.h"
#include "edit/state/resample_state.h"

#include "app/motion/retarget_files.h"
#include "benchmarks/parts/result_table.h"
#include "core/base/quantile.h"
#include "core/base/stopwatch.h"
#include "core/pose.h"

namespace marey {
namespace {

namespace fs = std::filesystem;
using Causes = std::map<std::string, int>;

constexpr double kMoved_m = 0.15;

/// Figures of the pieces of one clip.
struct ConstraintFigures {
  int pieces = 0;
  int refused = 0;
  double supports = 0.0;
  double touches = 0.0;
  double left_out = 0.0;
  double unmet = 0.0;
  double worst_mm = 0.0;
  double slide_before_mm = 0.0;
  double slide_mm = 0.0;
  double largest_mm = 0.0;
  double added_m_per_s2 = 0.0;
  double hand_unmet = 0.0;
  double hand_mm = 0.0;
  double seconds = 0.0;
  double motion_s = 0.0;
};

double figure_of(const edit::OpReport& report, const std::string& name) {
  for (const auto& [key, value] : report.figures) {
    if (key == name) return value;
  }
  return 0.0;
}

/// Removes names and numbers from a message.
std::string cause_of(const std::string& text) {
  std::string out;
  bool quoted = false;
  for (const char c : text) {
    if (c == '"') quoted = !quoted;
    const bool is_number = (c >= '0' && c <= '9') || c == '.';
    if (!quoted && !is_number) out += c;
  }
  return out;
}

void count(const edit::OpReport& report, Causes& causes) {
  for (const Finding& finding : report.findings) {
    ++causes[finding.id + ": " + cause_of(finding.cause)];
  }
}

/// Applies one operation; counts its error or its findings.
bool apply(const ConstrainOp& op,
           edit::EditState& state,
           edit::OpReport& report,
           Causes& causes) {
  EditOp whole;
  whole.parameters = op;
  const edit::EditInputs inputs;
  report = {};
  auto out = edit::apply_constrain(op, {whole, 0, inputs}, state, report);
  count(report, causes);
  if (!out) {
    ++causes["error: " + cause_of(out.error().cause)];
    return false;
  }
  state = *std::move(out);
  return true;
}

ConstrainOp hand_move(const edit::EditState& state) {
  ConstrainOp op;
  const int middle = state.frame_count() / 2;
  const auto joints = world_from_joints(
      state.motion.skeleton, state.motion.poses[static_cast<std::size_t>(middle)]);
  const auto hand = *state.map.joint_of[index(HumanBone::kRightHand)];
  Constraint& constraint = op.constraint.emplace();
  constraint.id = "moved hand";
  constraint.point.segment = "rightHand";
  constraint.goal = DistanceToPoint{
      0.0, joints[index(hand)].translation + glm::dvec3(0.0, kMoved_m, 0.0)};
  constraint.activation.start_duration_s = 0.4;
  constraint.activation.stop_duration_s = 0.4;
  const double middle_s = middle / state.motion.rate.hz;
  op.from = AtTime{middle_s - 0.25};
  op.to = AtTime{middle_s + 0.25};
  op.adapt = true;
  return op;
}

void measure_piece(edit::EditState state, ConstraintFigures& out, Causes& causes) {
  const Stopwatch watch;
  edit::OpReport report;
  ++out.pieces;
  out.motion_s += state.duration_s();
  out.slide_before_mm =
      std::max(out.slide_before_mm, edit::measure_slide(state).worst_drift_mm);
  const edit::EditState captured = state;
  for (const DetectConstraints kind :
       {DetectConstraints::kSupports, DetectConstraints::kTouches}) {
    ConstrainOp detect;
    detect.detect = kind;
    if (!apply(detect, state, report, causes)) {
      ++out.refused;
      return;
    }
    (kind == DetectConstraints::kSupports ? out.supports : out.touches) +=
        figure_of(report, "found");
  }
  ConstrainOp adapt;
  adapt.adapt = true;
  if (!apply(adapt, state, report, causes)) {
    ++out.refused;
    return;
  }
  out.left_out += figure_of(report, "left_out");
  out.unmet += figure_of(report, "unmet");
  out.worst_mm = std::max(out.worst_mm, figure_of(report, "worst_constraint_mm"));
  out.slide_mm = std::max(out.slide_mm, edit::measure_slide(state).worst_drift_mm);
  out.largest_mm = std::max(out.largest_mm, figure_of(report, "displaced_mm"));
  out.added_m_per_s2 =
      std::max(out.added_m_per_s2, figure_of(report, "added_acceleration_m_per_s2"));
  edit::EditState moved = captured;
  if (!apply(hand_move(moved), moved, report, causes)) {
    ++out.refused;
    return;
  }
  out.hand_unmet += figure_of(report, "unmet");
  out.hand_mm = std::max(out.hand_mm, figure_of(report, "error_mm.moved hand"));
  out.seconds += watch.seconds();
}

std::vector<TableCell> constraint_row(const std::string& name,
                                      const ConstraintFigures& f) {
  return {name,
          static_cast<double>(f.pieces),
          static_cast<double>(f.refused),
          f.supports,
          f.touches,
          f.left_out,
          f.unmet,
          f.worst_mm,
          f.slide_before_mm,
          f.slide_mm,
          f.largest_mm,
          f.added_m_per_s2,
          f.hand_unmet,
          f.hand_mm,
          f.seconds > 0.0 ? f.motion_s / f.seconds : 0.0};
}

int measure_all(const fs::path& mocap, double piece_s) {
  std::vector<fs::path> files;
  for (const char* folder : {"cmu_asfamc", "cmu_bvh_tmoco", "bandai", "bvh_python"}) {
    if (!fs::exists(mocap / folder)) continue;
    for (const auto& entry : fs::directory_iterator(mocap / folder)) {
      const std::string kind = entry.path().extension().string();
      if (kind == ".amc" || kind == ".bvh") files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  ResultTable table{"edit_constraints",
                    "Constraints found in captured clips, and adaptation to them",
                    {{"clip"},
                     {"pieces", 0},
                     {"refused", 0},
                     {"supports", 0},
                     {"touches", 0},
                     {"left out", 0},
                     {"unmet", 0},
                     {"worst mm", 1},
                     {"slide was mm", 1},
                     {"slide mm", 2},
                     {"moved mm", 0},
                     {"added m/s2", 0},
                     {"hand unmet", 0},
                     {"hand mm", 2},
                     {"x real time", 0}},
                    {},
                    {}};
  Causes causes;
  for (const fs::path& file : files) {
    const auto read = app::read_motion({file});
    if (!read) {
      ++causes["not read: " + cause_of(read.error().cause)];
      continue;
    }
    const auto state = edit::make_edit_state(read->motion);
    if (!state) {
      ++causes["not mapped: " + cause_of(state.error().cause)];
      continue;
    }
    ConstraintFigures figures;
    const int length = std::max(2, static_cast<int>(piece_s * read->motion.rate.hz));
    for (int first = 0; first == 0 || first + length / 2 < state->frame_count();
         first += length) {
      const int last = std::min(first + length, state->frame_count()) - 1;
      measure_piece(edit::slice_state(*state, {first, last}), figures, causes);
    }
    table.rows.push_back(constraint_row(file.filename().string(), figures));
  }
  print_table(table);
  for (const auto& [cause, times] : causes)
    std::printf("%4d  %s\n", times, cause.c_str());
  return table.rows.empty() ? 1 : 0;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: measure_constraints MOCAP [SECONDS]\n");
    return 2;
  }
  return marey::measure_all(argv[1], argc > 2 ? std::atof(argv[2]) : 4.0);
}
