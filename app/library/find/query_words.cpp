// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/find/query_words.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "app/shell/word_list.h"
#include "core/base/in_quotes.h"
#include "core/nearest_word.h"

namespace marey::app {
namespace {

using recordings::ClipNumber;
using recordings::ClipText;
using recordings::WordKind;
using Kind = QueryWord::Kind;

struct RecordWord {
  std::string_view word;
  QueryWord meaning;
};

const std::vector<RecordWord>& record_words() {
  const auto text = [](ClipText which) { return QueryWord{Kind::kText, which, {}, {}}; };
  const auto number = [](ClipNumber which) {
    return QueryWord{Kind::kNumber, {}, which, {}};
  };
  const auto other = [](Kind kind) { return QueryWord{kind, {}, {}, {}}; };
  static const std::vector<RecordWord> kWords = {
      {"body", text(ClipText::kBody)},
      {"duplicate", other(Kind::kDuplicate)},
      {"duplicate_of", text(ClipText::kDuplicateOf)},
      {"event", other(Kind::kEvent)},
      {"frames", number(ClipNumber::kFrames)},
      {"id", text(ClipText::kId)},
      {"kind", text(ClipText::kKind)},
      {"label", other(Kind::kLabel)},
      {"licence", text(ClipText::kLicence)},
      {"license", text(ClipText::kLicence)},
      {"mirror", other(Kind::kMirror)},
      {"mirror_of", text(ClipText::kMirrorOf)},
      {"name", text(ClipText::kName)},
      {"origin", text(ClipText::kOrigin)},
      {"problem", other(Kind::kProblem)},
      {"quality", other(Kind::kQuality)},
      {"rate", number(ClipNumber::kRateHz)},
      {"rate_by", text(ClipText::kRateBasis)},
      {"rate_hz", number(ClipNumber::kRateHz)},
      {"seconds", number(ClipNumber::kSeconds)},
      {"source", text(ClipText::kPath)},
      {"split", text(ClipText::kSplit)},
      {"subject", text(ClipText::kSubject)},
  };
  return kWords;
}

/// Returns true for the ends of figures' names that state a unit.
bool is_unit(std::string_view text) {
  constexpr std::array<std::string_view, 19> kUnits = {"mm",
                                                       "cm",
                                                       "m",
                                                       "s",
                                                       "ms",
                                                       "hz",
                                                       "deg",
                                                       "rad",
                                                       "share",
                                                       "cm_s",
                                                       "m_s",
                                                       "deg_s",
                                                       "rad_s",
                                                       "m_s2",
                                                       "ratio",
                                                       "count",
                                                       "frames",
                                                       "sigma",
                                                       "p95_mm"};
  return std::find(kUnits.begin(), kUnits.end(), text) != kUnits.end();
}

}  // namespace

Result<std::span<const std::string>> QueryVocabulary::words(WordKind kind) {
  auto found = words_.find(kind);
  if (found == words_.end()) {
    auto read = selector_.words(kind);
    if (!read) return read.error();
    found = words_.emplace(kind, *std::move(read)).first;
  }
  return std::span<const std::string>(found->second);
}

Result<std::vector<std::string>> QueryVocabulary::label_words() {
  const auto labels = words(WordKind::kLabel);
  if (!labels) return labels.error();
  std::vector<std::string> out;
  for (const std::string& label : *labels) {
    const std::size_t colon = label.find(':');
    if (colon == std::string::npos || colon == 0) continue;
    // Labels are in ascending order, those with the same word are neighbours.
    std::string word = label.substr(0, colon);
    if (out.empty() || out.back() != word) out.push_back(std::move(word));
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

Result<std::vector<std::string>> QueryVocabulary::figures_called(std::string_view word) {
  const auto figures = words(WordKind::kFigure);
  if (!figures) return figures.error();
  std::vector<std::string> out;
  for (const std::string& figure : *figures) {
    if (figure == word) return std::vector<std::string>{figure};
    const bool is_longer = figure.size() > word.size() + 1 && figure.starts_with(word) &&
                           figure[word.size()] == '_';
    if (is_longer && is_unit(std::string_view(figure).substr(word.size() + 1))) {
      out.push_back(figure);
    }
  }
  return out;
}

Result<std::optional<QueryWord>> QueryVocabulary::meaning(std::string_view word) {
  constexpr std::string_view kFigurePrefix = "figure.";
  using Meaning = std::optional<QueryWord>;
  const bool is_figure = word.starts_with(kFigurePrefix);
  if (is_figure) word.remove_prefix(kFigurePrefix.size());
  for (const RecordWord& known : record_words()) {
    if (!is_figure && known.word == word) return Meaning(known.meaning);
  }
  const auto figures = figures_called(word);
  if (!figures) return figures.error();
  if (figures->size() == 1) {
    return Meaning(QueryWord{Kind::kFigure, {}, {}, figures->front()});
  }
  if (is_figure) return Meaning();
  const auto labels = label_words();
  if (!labels) return labels.error();
  if (std::binary_search(labels->begin(), labels->end(), word)) {
    return Meaning(QueryWord{Kind::kLabelWord, {}, {}, std::string(word)});
  }
  return Meaning();
}

Result<std::vector<std::string>> QueryVocabulary::known_words(bool numbers_only) {
  std::set<std::string> out;
  for (const RecordWord& known : record_words()) {
    const Kind kind = known.meaning.kind;
    if (!numbers_only || kind == Kind::kNumber || kind == Kind::kQuality) {
      out.emplace(known.word);
    }
  }
  const auto figures = words(WordKind::kFigure);
  if (!figures) return figures.error();
  out.insert(figures->begin(), figures->end());
  if (!numbers_only) {
    const auto labels = label_words();
    if (!labels) return labels.error();
    out.insert(labels->begin(), labels->end());
  }
  return std::vector<std::string>(out.begin(), out.end());
}

std::string nearest_suggestion(std::string_view wrong,
                               std::span<const std::string> words) {
  constexpr std::size_t kListed = 40;
  constexpr std::size_t kNearest = 8;
  const std::vector<std::string_view> views(words.begin(), words.end());
  if (const auto meant = meant_word(wrong, views)) {
    return "perhaps you mean " + in_quotes(*meant);
  }
  if (views.size() <= kListed) return suggestion(wrong, views);
  std::vector<std::string> nearest;
  for (const std::string_view word : nearest_words(wrong, views, kNearest)) {
    nearest.push_back(in_quotes(word));
  }
  return "the nearest of " + std::to_string(views.size()) + " are " + or_list(nearest);
}

}  // namespace marey::app
