// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/find/query_clips.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>
#include <utility>

#include "library/search/relations.h"

#include "app/library/find/query_expression.h"
#include "app/library/find/query_tokens.h"
#include "app/library/find/query_words.h"
#include "core/base/in_quotes.h"
#include "recordings/library/select_clips.h"

namespace marey::app {
namespace {

using recordings::ClipSelector;
using recordings::ClipSet;
using recordings::ClipText;
using recordings::Comparison;
using recordings::WordKind;

bool is_negated(QueryOperator comparison) {
  return comparison == QueryOperator::kNotEqual ||
         comparison == QueryOperator::kContainsNot;
}

bool is_part(QueryOperator comparison) {
  return comparison == QueryOperator::kContains ||
         comparison == QueryOperator::kContainsNot;
}

bool is_order(QueryOperator comparison) {
  return comparison >= QueryOperator::kLess && comparison <= QueryOperator::kGreaterEqual;
}

/// Returns true if two numbers compare so.
bool compares(int a, QueryOperator comparison, int b) {
  switch (comparison) {
    case QueryOperator::kEqual:
      return a == b;
    case QueryOperator::kNotEqual:
      return a != b;
    case QueryOperator::kLess:
      return a < b;
    case QueryOperator::kLessEqual:
      return a <= b;
    case QueryOperator::kGreater:
      return a > b;
    case QueryOperator::kGreaterEqual:
      return a >= b;
    case QueryOperator::kContains:
    case QueryOperator::kContainsNot:
      break;
  }
  return false;
}

/// Returns the kind of words of a text whose values the index lists.
std::optional<WordKind> listed_words(ClipText text) {
  switch (text) {
    case ClipText::kKind:
      return WordKind::kKind;
    case ClipText::kLicence:
      return WordKind::kLicence;
    case ClipText::kSubject:
      return WordKind::kSubject;
    case ClipText::kSplit:
      return WordKind::kSplit;
    default:
      return std::nullopt;
  }
}

void add(const ClipSet& from, ClipSet& to) {
  for (std::size_t k = 0; k < to.size(); ++k) to[k] = to[k] || from[k];
}

/// Evaluates the tree of an expression on one library.
class QueryRun {
 public:
  QueryRun(const ClipSelector& selector,
           std::string_view expression,
           std::vector<std::string>& remarks)
      : selector_(selector),
        expression_(expression),
        vocabulary_(selector),
        remarks_(remarks) {}

  Result<ClipSet> evaluate(const QueryNode& node) {
    switch (node.kind) {
      case QueryNode::Kind::kAll:
        return everything(true);
      case QueryNode::Kind::kCondition:
        return condition(node.condition);
      case QueryNode::Kind::kNot:
        return inverse(evaluate(node.parts.front()), true);
      case QueryNode::Kind::kAnd:
      case QueryNode::Kind::kOr:
        break;
    }
    // (not a) and (not b) is not (a or b).
    const bool is_and = node.kind == QueryNode::Kind::kAnd;
    ClipSet out = everything(false);
    for (const QueryNode& part : node.parts) {
      const auto found = inverse(evaluate(part), is_and);
      if (!found) return found.error();
      add(*found, out);
    }
    return inverse(std::move(out), is_and);
  }

 private:
  [[nodiscard]] ClipSet everything(bool value) const {
    return ClipSet(static_cast<std::size_t>(selector_.clip_count()), value);
  }

  static Result<ClipSet> inverse(Result<ClipSet> set, bool is_inverse) {
    if (set && is_inverse) (*set).flip();
    return set;
  }

  Result<ClipSet> condition(const QueryCondition& at) {
    switch (at.kind) {
      case QueryCondition::Kind::kHas:
        return has(at);
      case QueryCondition::Kind::kEvent:
        return event(at);
      case QueryCondition::Kind::kText:
        return text(at);
      case QueryCondition::Kind::kCompare:
        break;
    }
    const auto meaning = vocabulary_.meaning(at.word);
    if (!meaning) return meaning.error();
    if (!*meaning) return unknown_word(at);
    const QueryWord& word = **meaning;
    switch (word.kind) {
      case QueryWord::Kind::kNumber:
      case QueryWord::Kind::kFigure:
        return compare_number(at, word);
      case QueryWord::Kind::kQuality:
        return compare_quality(at);
      case QueryWord::Kind::kDuplicate:
        return is_copy(at, ClipText::kDuplicateOf);
      case QueryWord::Kind::kMirror:
        return is_copy(at, ClipText::kMirrorOf);
      default:
        return compare_text(at, word);
    }
  }

  Error unknown_word(const QueryCondition& at) {
    const bool is_number = is_order(at.comparison);
    const auto known = vocabulary_.known_words(is_number);
    if (!known) return known.error();
    const std::string what = is_number ? " is no figure of this library"
                                       : " is no word of records, figures or labels of "
                                         "this library";
    return bad_query(expression_,
                     at.word_at,
                     in_quotes(at.word) + what,
                     nearest_suggestion(at.word, *known));
  }

  Result<ClipSet> compare_number(const QueryCondition& at, const QueryWord& word) {
    double value = 0.0;
    const char* const end = at.value.data() + at.value.size();
    const auto [rest, problem] = std::from_chars(at.value.data(), end, value);
    if (problem != std::errc() || rest != end || !std::isfinite(value)) {
      return bad_query(expression_,
                       at.value_at,
                       in_quotes(at.value) + " is no number",
                       "write a number without a unit, such as " + at.word + ">1.5");
    }
    if (is_part(at.comparison)) {
      return bad_query(expression_,
                       at.word_at,
                       in_quotes(at.word) + " is a number",
                       "compare it with = != < <= > or >=");
    }
    // The first six operators are those of the index.
    const auto comparison = static_cast<Comparison>(at.comparison);
    return word.kind == QueryWord::Kind::kNumber
               ? selector_.with_number(word.number, comparison, value)
               : selector_.with_figure(word.name, comparison, value);
  }

  Result<ClipSet> compare_quality(const QueryCondition& at) {
    const std::vector<std::string> verdicts = {"pass", "warn", "fail"};
    const auto place = std::find(verdicts.begin(), verdicts.end(), at.value);
    if (place == verdicts.end() || is_part(at.comparison)) {
      return bad_query(expression_,
                       place == verdicts.end() ? at.value_at : at.word_at,
                       "the quality is pass, warn or fail, in this order",
                       "write for example quality=pass or quality<=warn");
    }
    ClipSet out = everything(false);
    for (int k = 0; k < 3; ++k) {
      const auto limit = static_cast<int>(place - verdicts.begin());
      if (!compares(k, at.comparison, limit)) continue;
      const auto found = selector_.with_quality(static_cast<Verdict>(k));
      if (!found) return found.error();
      add(*found, out);
    }
    return out;
  }

  /// Clips that are copies of another one, or not.
  Result<ClipSet> is_copy(const QueryCondition& at, ClipText text) {
    const bool is_yes = at.value == "yes";
    if ((!is_yes && at.value != "no") || is_part(at.comparison) ||
        is_order(at.comparison)) {
      return bad_query(
          expression_,
          at.word_at,
          in_quotes(at.word) + " is yes or no",
          "write " + at.word + "=no, or " + at.word + "_of=ID for copies of one clip");
    }
    return inverse(selector_.with_text(text, ""), is_yes != is_negated(at.comparison));
  }

  Result<ClipSet> compare_text(const QueryCondition& at, const QueryWord& word) {
    if (is_order(at.comparison)) {
      return bad_query(expression_,
                       at.word_at,
                       in_quotes(at.word) + " is a text",
                       "compare it with = != ~ (contains) or !~");
    }
    return inverse(is_part(at.comparison) ? with_part(at, word) : with_value(at, word),
                   is_negated(at.comparison));
  }

  Result<ClipSet> with_value(const QueryCondition& at, const QueryWord& word) {
    using Kind = QueryWord::Kind;
    if (word.kind == Kind::kText) {
      if (const auto kind = listed_words(word.text)) remark(*kind, at.value, at.value);
      return selector_.with_text(word.text, at.value);
    }
    if (word.kind == Kind::kEvent) return event(at);
    if (word.kind == Kind::kProblem) {
      remark(WordKind::kProblem, at.value, at.value);
      return selector_.with_problem(at.value);
    }
    const std::string label =
        word.kind == Kind::kLabelWord ? word.name + ':' + at.value : at.value;
    remark(WordKind::kLabel, label, at.value);
    return selector_.with_label(label);
  }

  Result<ClipSet> with_part(const QueryCondition& at, const QueryWord& word) {
    using Kind = QueryWord::Kind;
    if (word.kind == Kind::kText) {
      return selector_.with_part_of_text(word.text, at.value);
    }
    if (word.kind == Kind::kLabel) return selector_.with_part_of_label(at.value);
    if (word.kind == Kind::kLabelWord) {
      return selector_.with_part_of_label(at.value, word.name + ':');
    }
    return bad_query(expression_,
                     at.word_at,
                     in_quotes(at.word) + " has no parts",
                     "compare it with = or !=");
  }

  Result<ClipSet> has(const QueryCondition& at) {
    const auto labels = vocabulary_.words(WordKind::kLabel);
    if (!labels) return labels.error();
    const bool is_label = std::binary_search(labels->begin(), labels->end(), at.value);
    if (!is_label && !library::relation(at.value)) {
      std::vector<std::string> known(labels->begin(), labels->end());
      for (int k = 0; k < library::kRelationCount; ++k) {
        known.emplace_back(library::name(static_cast<library::Relation>(k)));
      }
      return bad_query(
          expression_,
          at.value_at,
          in_quotes(at.value) + " is no relation and no label of this library",
          nearest_suggestion(at.value, known));
    }
    if (!is_label) remarks_.push_back(in_quotes(at.value) + " holds in no clip");
    return selector_.with_label(at.value, at.min_s);
  }

  Result<ClipSet> event(const QueryCondition& at) {
    remark(WordKind::kEvent, at.value, at.value);
    return selector_.with_event(at.value);
  }

  Result<ClipSet> text(const QueryCondition& at) {
    std::istringstream parts(at.value);
    std::vector<std::string> words;
    for (std::string word; parts >> word;) words.push_back(word);
    if (words.empty()) {
      return bad_query(
          expression_, at.value_at, "the words are missing", "write text(\"turn left\")");
    }
    return selector_.with_words(words);
  }

  /// Notes a value that no clip has, unless it is empty.
  void remark(WordKind kind, const std::string& value, const std::string& written) {
    constexpr std::array<std::string_view, 8> kNames = {"figure",
                                                        "label",
                                                        "event",
                                                        "problem",
                                                        "kind of file",
                                                        "licence",
                                                        "subject",
                                                        "split"};
    const auto known = vocabulary_.words(kind);
    if (!known || written.empty()) return;
    if (std::binary_search(known->begin(), known->end(), value)) return;
    std::string text = "no clip has the ";
    text.append(kNames[static_cast<std::size_t>(kind)]).append(1, ' ');
    text += in_quotes(value);
    if (!known->empty()) text += "; " + nearest_suggestion(value, *known);
    remarks_.push_back(std::move(text));
  }

  const ClipSelector& selector_;
  std::string_view expression_;
  QueryVocabulary vocabulary_;
  std::vector<std::string>& remarks_;
};

}  // namespace

Result<ClipQuery> run_clip_query(const std::filesystem::path& library,
                                 const std::string& expression) {
  const auto tree = parse_query(expression);
  if (!tree) return tree.error();
  const auto selector = ClipSelector::open(library / "library.sqlite");
  if (!selector) return selector.error();
  ClipQuery out;
  const auto found = QueryRun(*selector, expression, out.remarks).evaluate(*tree);
  if (!found) return found.error();
  for (std::size_t k = 0; k < found->size(); ++k) {
    if ((*found)[k]) out.numbers.push_back(static_cast<int>(k));
  }
  return out;
}

Result<std::vector<int>> query_clips(const std::filesystem::path& library,
                                     const std::string& expression) {
  auto query = run_clip_query(library, expression);
  if (!query) return query.error();
  return std::move((*query).numbers);
}

}  // namespace marey::app
