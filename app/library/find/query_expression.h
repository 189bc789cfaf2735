// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace marey::app {

enum class QueryOperator {
  kEqual,
  kNotEqual,
  kLess,
  kLessEqual,
  kGreater,
  kGreaterEqual,
  kContains,
  kContainsNot,
};

/// One condition of an expression. Its words are not checked yet.
struct QueryCondition {
  enum class Kind {
    kCompare,  ///< `word` `comparison` `value`: content=walk.
    kHas,      ///< has(`value`), has(`value` for `min_s` s).
    kEvent,    ///< event(`value`).
    kText,     ///< text(`value`).
  };
  Kind kind = Kind::kCompare;
  std::string word;
  QueryOperator comparison = QueryOperator::kEqual;
  std::string value;
  double min_s = 0.0;
  std::size_t word_at = 0;  ///< Offsets in the expression, for messages.
  std::size_t value_at = 0;
};

/// A node of the tree of an expression.
struct QueryNode {
  enum class Kind {
    kAll,  ///< An empty expression: all clips.
    kCondition,
    kAnd,
    kOr,
    kNot,
  };
  Kind kind = Kind::kAll;
  QueryCondition condition;      ///< Only for kCondition.
  std::vector<QueryNode> parts;  ///< Two or more of kAnd and kOr, one of kNot.
};

/// Limits of an expression: parentheses and `not` inside each other, and conditions.
inline constexpr int kMaxQueryDepth = 100;
inline constexpr int kMaxQueryConditions = 500;

/// Parses an expression (docs/library_queries.md). Errors (kUsage), with the column:
/// those of query_tokens(); an unexpected or missing part; beyond a limit. Linear.
[[nodiscard]] Result<QueryNode> parse_query(std::string_view expression);

}  // namespace marey::app
