// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace marey {

/// Source of a value.
enum class Source {
  kMeasured,  ///< Seen by at least one camera at this instant; see kInferred for limbs.
  kRepaired,  ///< Seen shortly before and after; bridged between.
  /// Never seen, or not for a long time; or a limb's joint whose sigma from the body's
  /// visible tags exceeds 15 mm: follows from its neighbours and priors.
  kInferred,
};

/// Returns "measured", "repaired" or "inferred": the words of segments.csv.
[[nodiscard]] constexpr std::string_view name(Source source) {
  switch (source) {
    case Source::kMeasured:
      return "measured";
    case Source::kRepaired:
      return "repaired";
    case Source::kInferred:
      return "inferred";
  }
  return "inferred";
}

}  // namespace marey
