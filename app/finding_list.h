// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "app/calibration_report.h"
#include "core/assert.h"

namespace marey::app {

/// A finding that several cameras may share.
struct SharedFinding {
  Finding finding;     ///< As it is told of one camera.
  std::string figure;  ///< What differs between them: "19 %". Empty: never shared.
  std::string cause;   ///< As it is told of several.
};

/// Findings while they are gathered, with words for their figures.
struct FindingList {
  const CalibrationReport& report;
  std::vector<SharedFinding> found;

  void add(Severity severity,
           const char* kind,
           std::string where,
           std::string cause,
           std::string next) {
    found.push_back(
        {{severity, kind, std::move(where), std::move(cause), std::move(next)}, "", ""});
  }
  /// Likewise, of a camera that need not be the only one: `cause_of_many` follows their
  /// names and figures.
  void add_shared(Severity severity,
                  const char* kind,
                  std::size_t c,
                  std::string cause,
                  std::string next,
                  std::string figure,
                  std::string cause_of_many) {
    add(severity, kind, camera(c), std::move(cause), std::move(next));
    found.back().figure = report.rig.cameras[c].name + " (" + figure + ")";
    found.back().cause = std::move(cause_of_many);
  }

  [[nodiscard]] std::string camera(std::size_t c) const {
    return "camera " + report.rig.cameras[c].name;
  }
  [[nodiscard]] std::string both(std::size_t a, std::size_t b) const {
    return "cameras " + report.rig.cameras[a].name + " and " + report.rig.cameras[b].name;
  }
  [[nodiscard]] const char* target() const { return report.extent ? "board" : "wand"; }
};

/// printf() of numbers and words, however long.
template <class... Values>
[[nodiscard]] std::string worded(const char* format, Values... values) {
  const int length = std::snprintf(nullptr, 0, format, values...);
  MAREY_ASSERT(length >= 0);
  std::string text(static_cast<std::size_t>(length), '\0');
  std::snprintf(text.data(), text.size() + 1, format, values...);
  return text;
}

/// The graver one when `value` goes beyond its limit.
[[nodiscard]] inline Severity graver(double value, double poor_above) {
  return value > poor_above ? Severity::kPoor : Severity::kFair;
}

}  // namespace marey::app
