// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/find/query_expression.h"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "app/library/find/query_tokens.h"
#include "core/base/in_quotes.h"
#include "core/base/lower_case.h"

namespace marey::app {
namespace {

using TokenKind = QueryToken::Kind;

QueryOperator operator_named(std::string_view text) {
  constexpr std::array<std::string_view, 8> kOperators = {
      "=", "!=", "<", "<=", ">", ">=", "~", "!~"};
  for (std::size_t k = 0; k < kOperators.size(); ++k) {
    if (kOperators[k] == text) return static_cast<QueryOperator>(k);
  }
  return QueryOperator::kEqual;
}

/// Recursive descent over the tokens:
///   either    = both { "or" both }
///   both      = single { "and" single }
///   single    = "not" single | "(" either ")" | condition
///   condition = "has" "(" words [ "for" seconds ] ")" | "event" "(" words ")"
///             | "text" "(" words ")" | word operator value
class QueryParser {
 public:
  QueryParser(std::string_view expression, std::vector<QueryToken> tokens)
      : expression_(expression), tokens_(std::move(tokens)) {}

  Result<QueryNode> parse() {
    QueryNode root;
    if (now().kind != TokenKind::kEnd) {
      root = either(0);
      if (!mistake_ && now().kind == TokenKind::kClose) {
        fail(now().begin, "a \")\" without its \"(\"", "remove it, or add a \"(\"");
      } else if (!mistake_ && now().kind != TokenKind::kEnd) {
        fail(now().begin,
             in_quotes(now().text) + " after a complete condition",
             "join conditions with and, or; put texts with blanks in quotation marks");
      }
    }
    if (mistake_) return *mistake_;
    return root;
  }

 private:
  [[nodiscard]] const QueryToken& now() const { return tokens_[next_]; }
  QueryToken take() {
    // The end is never passed.
    if (next_ + 1 < tokens_.size()) return tokens_[next_++];
    return tokens_[next_];
  }
  [[nodiscard]] bool is_word(std::string_view word) const {
    return now().kind == TokenKind::kWord && lower_case(now().text) == word;
  }
  /// True at `word` "(".
  [[nodiscard]] bool is_call(std::string_view word) const {
    return is_word(word) && tokens_[next_ + 1].kind == TokenKind::kOpen;
  }

  QueryNode either(int depth) {
    return joined("or", QueryNode::Kind::kOr, [&] { return both(depth); });
  }

  QueryNode both(int depth) {
    return joined("and", QueryNode::Kind::kAnd, [&] { return single(depth); });
  }

  template <class Part>
  QueryNode joined(std::string_view word, QueryNode::Kind kind, const Part& part) {
    QueryNode first = part();
    if (mistake_ || !is_word(word)) return first;
    QueryNode out;
    out.kind = kind;
    out.parts.push_back(std::move(first));
    while (!mistake_ && is_word(word)) {
      take();
      out.parts.push_back(part());
    }
    return out;
  }

  QueryNode single(int depth) {
    if (depth > kMaxQueryDepth) {
      return fail(now().begin,
                  "more than " + std::to_string(kMaxQueryDepth) +
                      " parentheses and words \"not\" inside each other",
                  "write it with fewer of them");
    }
    if (is_word("not")) {
      take();
      QueryNode out;
      out.kind = QueryNode::Kind::kNot;
      out.parts.push_back(single(depth + 1));
      return out;
    }
    if (now().kind != TokenKind::kOpen) return condition();
    const std::size_t opened = take().begin;
    QueryNode out = either(depth + 1);
    if (mistake_) return out;
    if (now().kind != TokenKind::kClose) return fail_unclosed(opened);
    take();
    return out;
  }

  QueryNode condition() {
    if (++conditions_ > kMaxQueryConditions) {
      return fail(now().begin,
                  "more than " + std::to_string(kMaxQueryConditions) + " conditions",
                  "divide it into several queries");
    }
    QueryNode out;
    out.kind = QueryNode::Kind::kCondition;
    out.condition.word_at = now().begin;
    if (is_call("has")) return call(std::move(out), QueryCondition::Kind::kHas);
    if (is_call("event")) return call(std::move(out), QueryCondition::Kind::kEvent);
    if (is_call("text")) return call(std::move(out), QueryCondition::Kind::kText);
    return compare(std::move(out));
  }

  QueryNode compare(QueryNode out) {
    constexpr const char* kExample =
        "write conditions such as content=walk, joined with and, or, not";
    if (now().kind == TokenKind::kEnd) {
      return fail(now().begin, "a condition is missing", kExample);
    }
    if (now().kind != TokenKind::kWord || is_word("and") || is_word("or")) {
      return fail(now().begin,
                  "a condition is missing before " + in_quotes(now().text),
                  kExample);
    }
    out.condition.word = take().text;
    if (now().kind != TokenKind::kOperator) {
      return fail(now().begin,
                  "no comparison follows " + in_quotes(out.condition.word),
                  "add one of = != < <= > >= ~ and a value, or write text(" +
                      out.condition.word + ") for clips with this word");
    }
    out.condition.comparison = operator_named(take().text);
    if (now().kind != TokenKind::kWord && now().kind != TokenKind::kQuoted) {
      return fail(now().begin,
                  "the value of " + in_quotes(out.condition.word) + " is missing",
                  "add it; \"\" is the empty text");
    }
    out.condition.value_at = now().begin;
    out.condition.value = take().text;
    return out;
  }

  /// Reads the words in the parentheses of has(), event() and text().
  QueryNode call(QueryNode out, QueryCondition::Kind kind) {
    out.condition.kind = kind;
    out.condition.word = take().text;
    const std::size_t opened = take().begin;
    out.condition.value_at = now().begin;
    while (now().kind == TokenKind::kWord || now().kind == TokenKind::kQuoted) {
      const bool is_duration = kind == QueryCondition::Kind::kHas && is_word("for");
      if (is_duration) {
        take();
        out.condition.min_s = duration_s();
        break;
      }
      if (!out.condition.value.empty()) out.condition.value += ' ';
      out.condition.value += take().text;
    }
    if (mistake_) return out;
    if (out.condition.value.empty()) {
      return fail(out.condition.value_at,
                  "the words of " + out.condition.word + "() are missing",
                  "write for example has(hand_right above head for 0.3 s), "
                  "event(left.strike) or text(\"turn left\")");
    }
    if (now().kind != TokenKind::kClose) return fail_unclosed(opened);
    take();
    return out;
  }

  /// Reads "0.3", "0.3 s" or "300ms".
  double duration_s() {
    const QueryToken number = take();
    double value = 0.0;
    const char* const end = number.text.data() + number.text.size();
    const auto [rest, problem] = std::from_chars(number.text.data(), end, value);
    std::string unit(rest, end);
    const bool has_unit = unit.empty() && (is_word("s") || is_word("ms"));
    if (has_unit) unit = take().text;
    const bool is_valid = number.kind == TokenKind::kWord && problem == std::errc() &&
                          std::isfinite(value) && value >= 0.0 &&
                          (unit.empty() || unit == "s" || unit == "ms");
    if (!is_valid) {
      fail(number.begin,
           in_quotes(number.text) + " is no duration",
           "write a number of seconds, such as for 0.3 s");
    }
    return unit == "ms" ? value / 1000.0 : value;
  }

  QueryNode fail_unclosed(std::size_t opened) {
    if (now().kind == TokenKind::kEnd) {
      return fail(opened, "this \"(\" is not closed", "add a \")\"");
    }
    return fail(now().begin,
                in_quotes(now().text) + " where a \")\" is expected",
                "close the parenthesis, or join conditions with and, or");
  }

  QueryNode fail(std::size_t at, std::string cause, std::string next) {
    if (!mistake_) {
      mistake_ = bad_query(expression_, at, std::move(cause), std::move(next));
    }
    return {};
  }

  std::string_view expression_;
  std::vector<QueryToken> tokens_;
  std::size_t next_ = 0;
  int conditions_ = 0;
  std::optional<Error> mistake_;
};

}  // namespace

Result<QueryNode> parse_query(std::string_view expression) {
  auto tokens = query_tokens(expression);
  if (!tokens) return tokens.error();
  return QueryParser(expression, *std::move(tokens)).parse();
}

}  // namespace marey::app
