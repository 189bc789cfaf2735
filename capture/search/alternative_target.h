// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace marey::capture {

/// A target in a recording that is not the expected one.
struct AlternativeTarget {
  std::string what;    ///< "markers 0 to 9 of DICT_4X4_50 are": inserted after "but".
  std::string remedy;  ///< The key to change in session.toml, or the recording to repeat.
};

}  // namespace marey::capture
