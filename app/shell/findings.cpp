// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/shell/findings.h"

#include <cmath>
#include <utility>

namespace marey::app {
namespace {

double thousandths(double value) {
  return std::round(1e3 * value) / 1e3;
}

}  // namespace

void print_warnings(Console& console, std::span<const Finding> findings) {
  for (const Finding& finding : findings) {
    if (finding.severity == Severity::kFair) console.warn(finding.message());
  }
}

Exit print_failures(Console& console, std::span<const Finding> findings) {
  Exit exit = Exit::kOk;
  for (const Finding& finding : findings) {
    if (finding.severity == Severity::kPoor) exit = console.fail(finding.error());
  }
  return exit;
}

std::vector<std::string> messages(std::span<const Finding> findings,
                                  Severity min_severity) {
  std::vector<std::string> out;
  for (const Finding& finding : findings) {
    if (finding.severity >= min_severity) out.push_back(finding.message());
  }
  return out;
}

const char* name(Severity severity) {
  switch (severity) {
    case Severity::kPoor:
      return "poor";
    case Severity::kFair:
      return "fair";
    case Severity::kNote:
      break;
  }
  return "note";
}

nlohmann::ordered_json findings_json(std::span<const Finding> findings) {
  auto out = nlohmann::ordered_json::array();
  for (const Finding& finding : findings) {
    nlohmann::ordered_json row{{"severity", name(finding.severity)},
                               {"kind", finding.id},
                               {"where", finding.where},
                               {"cause", finding.cause},
                               {"next", finding.next}};
    if (finding.value) row["value"] = thousandths(*finding.value);
    if (finding.limit) row["limit"] = thousandths(*finding.limit);
    if (finding.value || finding.limit) row["unit"] = finding.unit;
    out.push_back(std::move(row));
  }
  return out;
}

}  // namespace marey::app
