// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace marey {

/// Where a value comes from.
enum class Source {
  kMeasured,  ///< Seen by at least one camera at this instant; see kInferred for limbs.
  kRepaired,  ///< Seen shortly before and after; bridged between.
  /// Never or long not seen, or a limb's joint that is known to no better than 15 mm by
  /// what is seen of the body's tags: follows from its neighbours and priors.
  kInferred,
};

/// "measured", "repaired", "inferred": the words of segments.csv.
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
