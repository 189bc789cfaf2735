// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "core/base/result.h"

namespace marey {

enum class Severity {
  kNote,  ///< Information; no action is needed.
  kFair,  ///< The result can be used, but can be improved: a warning.
  kPoor,  ///< The result should not be trusted, or a part of it is missing: an error.
};

/// A statement on the quality of an input or a result that does not end the work. All
/// texts are plain sentences or names without a trailing full stop. An Error ends the
/// work instead.
struct Finding {
  Severity severity = Severity::kNote;
  std::string id;     ///< One word for programs: "coverage", "tilt"; may be empty.
  std::string where;  ///< File, trial or camera: "camera left", "trial walk".
  std::string cause;  ///< The measured value, in a sentence.
  std::string next;   ///< The next step of the user; empty if there is none.
  std::optional<double> value{};  ///< The measured value, in `unit`.
  std::optional<double> limit{};  ///< In `unit`: maximum of errors, minimum of counts.
  std::string unit{};             ///< "px", "mm", "share"...
  /// Kind of an error that was tolerated, such as an unreadable video. Determines the
  /// program's exit code if the severity is kPoor.
  Errc code = Errc::kQuality;

  /// Sets value, limit and unit; `value_limit` is nullopt if there is no fixed limit.
  Finding& measured(double measured_value,
                    std::optional<double> value_limit,
                    std::string of_unit) {
    value = measured_value;
    limit = value_limit;
    unit = std::move(of_unit);
    return *this;
  }
  [[nodiscard]] Error error() const { return {code, where, cause, next}; }
  /// One line: "where: cause. Next: next."
  [[nodiscard]] std::string message() const { return error().message(); }
};

/// Returns the finding for an error that is tolerated.
[[nodiscard]] inline Finding tolerated(Severity severity, std::string id, Error error) {
  Finding finding{severity,
                  std::move(id),
                  std::move(error.where),
                  std::move(error.cause),
                  std::move(error.next)};
  finding.code = error.code;
  return finding;
}

[[nodiscard]] inline Finding fair_finding(std::string id,
                                          std::string where,
                                          std::string cause,
                                          std::string next = "") {
  return {Severity::kFair,
          std::move(id),
          std::move(where),
          std::move(cause),
          std::move(next)};
}

[[nodiscard]] inline Finding poor_finding(std::string id,
                                          std::string where,
                                          std::string cause,
                                          std::string next) {
  return {Severity::kPoor,
          std::move(id),
          std::move(where),
          std::move(cause),
          std::move(next)};
}

}  // namespace marey
