// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace marey::app {

/// A part of an expression.
struct QueryToken {
  enum class Kind {
    kWord,      ///< Letters, digits and all signs that are none of the others.
    kQuoted,    ///< A text in quotation marks, without them.
    kOperator,  ///< = != < <= > >= ~ !~
    kOpen,
    kClose,
    kEnd,
  };
  Kind kind = Kind::kEnd;
  std::string text;
  std::size_t begin = 0;  ///< Offset of its first byte in the expression.
};

/// Returns the error (kUsage) of an expression at the byte `at`: the column, and the
/// expression around it with a ^ before that place.
[[nodiscard]] Error bad_query(std::string_view expression,
                              std::size_t at,
                              std::string cause,
                              std::string next);

/// Divides an expression into tokens; the last one is kEnd. In quotation marks (" or '),
/// a backslash takes the next character as it is. Errors (kUsage): a quotation mark that
/// is not closed; control characters, and bytes that are not UTF-8; longer than
/// kMaxQueryBytes. Linear.
[[nodiscard]] Result<std::vector<QueryToken>> query_tokens(std::string_view expression);

inline constexpr std::size_t kMaxQueryBytes = 65536;

}  // namespace marey::app
