// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "calib/quality/calibration_report.h"
#include "core/base/format_text.h"

namespace marey::calib {

/// A finding of one camera that other cameras may have, too. assess_calibration() merges
/// those with equal `cause` into one Finding, so that ten cameras do not give ten lines.
struct MergeableFinding {
  Finding finding;  ///< Text used when the finding covers one camera.
  /// Name and value of the camera: "left (19 %)". Empty: the finding is never merged.
  std::string figure;
  std::string cause;  ///< Text used when the finding covers several cameras.
};

/// Collects the findings of a calibration and formats their values. `report` must outlive
/// the object.
struct FindingCollector {
  const CalibrationReport& report;
  std::vector<MergeableFinding> found;

  /// Returns the finding, valid until the next one is added.
  Finding& add(Severity severity,
               const char* id,
               std::string where,
               std::string cause,
               std::string next) {
    found.push_back(
        {{severity, id, std::move(where), std::move(cause), std::move(next)}, "", ""});
    return found.back().finding;
  }
  /// Adds a finding that several cameras may have. `cause_of_many` follows their names
  /// and values in the text.
  Finding& add_mergeable(Severity severity,
                         const char* id,
                         std::size_t c,
                         std::string cause,
                         std::string next,
                         std::string figure,
                         std::string cause_of_many) {
    add(severity, id, camera(c), std::move(cause), std::move(next));
    found.back().figure = report.rig.cameras[c].name + " (" + figure + ")";
    found.back().cause = std::move(cause_of_many);
    return found.back().finding;
  }

  [[nodiscard]] std::string camera(std::size_t c) const {
    return "camera " + report.rig.cameras[c].name;
  }
  [[nodiscard]] std::string both(std::size_t a, std::size_t b) const {
    return "cameras " + report.rig.cameras[a].name + " and " + report.rig.cameras[b].name;
  }
  [[nodiscard]] const char* target() const { return report.extent ? "board" : "wand"; }
};

/// Returns kPoor if `value` exceeds its limit, else kFair.
[[nodiscard]] inline Severity severity_of(double value, double poor_above) {
  return value > poor_above ? Severity::kPoor : Severity::kFair;
}

}  // namespace marey::calib
