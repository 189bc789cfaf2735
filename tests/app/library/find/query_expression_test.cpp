// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/find/query_expression.h"

#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "app/library/find/query_tokens.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::app {
namespace {

/// Returns the tree in a plain form: "(a = 1 AND NOT b > 2)".
std::string tree_text(const QueryNode& node) {
  constexpr const char* kOperators[] = {"=", "!=", "<", "<=", ">", ">=", "~", "!~"};
  const QueryCondition& at = node.condition;
  switch (node.kind) {
    case QueryNode::Kind::kAll:
      return "ALL";
    case QueryNode::Kind::kNot:
      return "NOT " + tree_text(node.parts.front());
    case QueryNode::Kind::kCondition:
      if (at.kind != QueryCondition::Kind::kCompare) {
        return at.word + "[" + at.value + "]" +
               (at.min_s > 0.0 ? std::to_string(at.min_s).substr(0, 4) : "");
      }
      return at.word + " " + kOperators[static_cast<int>(at.comparison)] + " " + at.value;
    case QueryNode::Kind::kAnd:
    case QueryNode::Kind::kOr:
      break;
  }
  std::string out = "(";
  for (const QueryNode& part : node.parts) {
    if (out.size() > 1) out += node.kind == QueryNode::Kind::kAnd ? " AND " : " OR ";
    out += tree_text(part);
  }
  return out + ")";
}

std::string parsed(std::string_view expression) {
  const auto tree = parse_query(expression);
  return tree ? tree_text(*tree) : tree.error().message();
}

TEST(QueryExpression, HasConditionsJoinedByWords) {
  EXPECT_EQ(parsed("content=walk"), "content = walk");
  EXPECT_EQ(parsed("content = walk and speed>1.2"), "(content = walk AND speed > 1.2)");
  EXPECT_EQ(parsed("a=1 or b=2 and c=3"), "(a = 1 OR (b = 2 AND c = 3))");
  EXPECT_EQ(parsed("(a=1 or b=2) and not c=3"), "((a = 1 OR b = 2) AND NOT c = 3)");
  EXPECT_EQ(parsed("not not a=1 AND b<=2"), "(NOT NOT a = 1 AND b <= 2)");
  EXPECT_EQ(parsed("a=1 or b=2 or c!=3"), "(a = 1 OR b = 2 OR c != 3)");
  EXPECT_EQ(parsed("a>=1 and b~x and c!~y and d<3"),
            "(a >= 1 AND b ~ x AND c !~ y AND d < 3)");
  EXPECT_EQ(parsed(""), "ALL");
  EXPECT_EQ(parsed(" \t\n "), "ALL");
}

TEST(QueryExpression, HasTextsInQuotationMarks) {
  EXPECT_EQ(parsed("label~\"turn left\""), "label ~ turn left");
  EXPECT_EQ(parsed("name='it is \"so\"'"), "name = it is \"so\"");
  EXPECT_EQ(parsed("name=\"a\\\"b\\\\c\""), "name = a\"b\\c");
  EXPECT_EQ(parsed("subject=\"\""), "subject = ");
  EXPECT_EQ(parsed("name=and or name=\"or\""), "(name = and OR name = or)");
  EXPECT_EQ(parsed("name=marché"), "name = marché");
  EXPECT_EQ(parsed("licence=CC-BY-NC-4.0"), "licence = CC-BY-NC-4.0");
  EXPECT_EQ(parsed("label=content:walk"), "label = content:walk");
}

TEST(QueryExpression, HasRelationsEventsAndWords) {
  EXPECT_EQ(parsed("has(hand_right above head for 0.3 s)"),
            "has[hand_right above head]0.30");
  EXPECT_EQ(parsed("has( lying )"), "has[lying]");
  EXPECT_EQ(parsed("has(flight for 200ms)"), "has[flight]0.20");
  EXPECT_EQ(parsed("has(flight for 2)"), "has[flight]2.00");
  EXPECT_EQ(parsed("has(flight for 250 ms) and a=1"), "(has[flight]0.25 AND a = 1)");
  EXPECT_EQ(parsed("event(left.strike)"), "event[left.strike]");
  EXPECT_EQ(parsed("text(\"turn left\")"), "text[turn left]");
  EXPECT_EQ(parsed("not text(walk slow for)"), "NOT text[walk slow for]");
  EXPECT_EQ(parsed("has=1"), "has = 1") << "only before a parenthesis";
}

TEST(QueryExpression, StatesColumnAndCauseOfMistakes) {
  const auto expect = [](std::string_view expression,
                         std::string_view column,
                         std::string_view cause) {
    const std::string message = parsed(expression);
    EXPECT_NE(message.find(column), std::string::npos) << expression << ": " << message;
    EXPECT_NE(message.find(cause), std::string::npos) << expression << ": " << message;
    EXPECT_NE(message.find("Next: "), std::string::npos) << expression << ": " << message;
  };
  expect("content=walk and", "column 17 (content=walk and^)", "a condition is missing");
  expect("and a=1", "column 1 (^and a=1)", "a condition is missing before \"and\"");
  expect("a=1 b=2", "column 5 (a=1 ^b=2)", "\"b\" after a complete condition");
  expect("(a=1", "column 1 (^(a=1)", "is not closed");
  expect("a=1)", "column 4 (a=1^))", "without its");
  expect("((a=1)", "column 1", "is not closed");
  expect("(a=1 b=2)", "column 6", "where a \")\" is expected");
  expect("()", "column 2", "a condition is missing before \")\"");
  expect("walk", "column 5 (walk^)", "no comparison follows \"walk\"");
  expect("a=", "column 3", "the value of \"a\" is missing");
  expect("a==1", "column 3", "the value of \"a\" is missing");
  expect("=1", "column 1", "a condition is missing before \"=\"");
  expect("name=\"walk", "column 6", "the quotation mark is not closed");
  expect("has()", "column 5", "the words of has() are missing");
  expect("text(\"\")", "column 6", "the words of text() are missing");
  expect("has(flight for)", "column 15", "is no duration");
  expect("has(flight for ever)", "column 16", "\"ever\" is no duration");
  expect("has(flight for -1 s)", "column 16", "is no duration");
  expect("has(flight for nan)", "column 16", "is no duration");
  expect("has(flight for 1e999)", "column 16", "is no duration");
  expect("has(flight for 1 s 2)", "column 20", "where a \")\" is expected");
  expect("has(for 1 s)", "column 5", "the words of has() are missing");
  expect("has(flight", "column 4", "is not closed");
  expect("é=1 and", "column 8 (é=1 and^)", "a condition is missing");
  expect("not", "column 4", "a condition is missing");
  expect("!", "column 2", "no comparison follows \"!\"");
  expect(std::string_view("a=1\0", 4), "column 4", "control character");
  expect("a=\xff", "column 3", "not UTF-8");
}

TEST(QueryExpression, HasLimits) {
  const auto repeated = [](const std::string& part, int count) {
    std::string out;
    for (int k = 0; k < count; ++k) out += part;
    return out;
  };
  const auto nested = [&](int count) {
    return parsed(repeated("(", count) + "a=1" + repeated(")", count));
  };
  EXPECT_EQ(nested(kMaxQueryDepth), "a = 1");
  EXPECT_NE(nested(kMaxQueryDepth + 1).find("inside each other"), std::string::npos);
  EXPECT_NE(parsed(repeated("(", 60000)).find("inside each other"), std::string::npos);
  EXPECT_NE(parsed(repeated("not ", 15000)).find("inside each other"), std::string::npos);
  EXPECT_TRUE(parse_query("a=1" + repeated(" or a=1", kMaxQueryConditions - 1)));
  EXPECT_NE(parsed("a=1" + repeated(" or a=1", kMaxQueryConditions)).find("conditions"),
            std::string::npos);
  EXPECT_NE(parsed(repeated("a", 100'000)).find("longer than"), std::string::npos);
  EXPECT_LT(parsed("a=1 " + repeated("é", 30'000)).size(), 1000u)
      << "messages stay short";
}

// Proves that no text ends the program, and that every refusal has a column.
TEST(QueryExpression, SurvivesRandomTexts) {
  const std::string_view parts[] = {"a",    "=",   "!=",   "(",     ")",    "and", "or",
                                    "not",  "has", "for",  "event", "text", "\"",  "'",
                                    "\\",   "1.5", " ",    "~",     "<",    ">=",  "é",
                                    "\xc3", "\n",  "walk", "s",     "ms",   "!",   ":"};
  testing::Dice dice(3);
  for (int k = 0; k < 20'000; ++k) {
    std::string text;
    const int count = static_cast<int>(dice.between(0.0, 14.0));
    for (int part = 0; part < count; ++part) {
      text += parts[static_cast<std::size_t>(
          dice.between(0.0, static_cast<double>(std::size(parts)) - 1e-9))];
      if (dice.between(0.0, 1.0) < 0.5) text += ' ';
    }
    const auto tree = parse_query(text);
    if (!tree) {
      EXPECT_EQ(tree.error().code, Errc::kUsage);
      EXPECT_NE(tree.error().where.find("column "), std::string::npos) << text;
      EXPECT_FALSE(tree.error().next.empty()) << text;
    }
  }
}

}  // namespace
}  // namespace marey::app
