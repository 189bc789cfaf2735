// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/quality/assess_calibration.h"

#include <algorithm>

#include "calib/quality/assess_board_print.h"
#include "calib/quality/assess_camera_faults.h"
#include "calib/quality/assess_point_error.h"
#include "calib/quality/assess_residuals.h"
#include "calib/quality/assess_target_views.h"
#include "calib/quality/assess_timing.h"
#include "calib/quality/finding_collector.h"

namespace marey::calib {
namespace {

/// Merges findings that several cameras share into one, at the position of the first.
std::vector<Finding> merge_findings(std::vector<MergeableFinding> found) {
  std::vector<Finding> out;
  for (std::size_t i = 0; i < found.size(); ++i) {
    MergeableFinding& first = found[i];
    if (first.finding.where.empty()) continue;
    int count = 0;
    std::string names;
    for (std::size_t k = i; k < found.size() && !first.figure.empty(); ++k) {
      MergeableFinding& other = found[k];
      if (other.cause != first.cause || other.figure.empty() ||
          other.finding.severity != first.finding.severity) {
        continue;
      }
      ++count;
      names += (names.empty() ? "" : ", ") + other.figure;
      if (k > i) other.finding.where.clear();
    }
    if (count > 1) {
      first.finding.where = "cameras " + names;
      first.finding.cause = first.cause;
      // Each camera has its own, in `where`.
      first.finding.value.reset();
    }
    out.push_back(std::move(first.finding));
  }
  return out;
}

}  // namespace

std::vector<Finding> assess_calibration(const CalibrationReport& report) {
  FindingCollector list{report, {}};
  assess_board_print(list);
  assess_point_error(list);
  assess_camera_faults(list);
  assess_timing(list);
  assess_residuals(list);
  assess_target_views(list);
  std::vector<Finding> out = merge_findings(std::move(list.found));
  std::stable_sort(out.begin(), out.end(), [](const Finding& a, const Finding& b) {
    return a.severity > b.severity;
  });
  return out;
}

const char* verdict_of(const CalibrationReport& report) {
  if (report.findings.empty()) return "good";
  switch (report.findings.front().severity) {
    case Severity::kPoor:
      return "look closer";
    case Severity::kFair:
      return "fair";
    case Severity::kNote:
      break;
  }
  return "good";
}

}  // namespace marey::calib
