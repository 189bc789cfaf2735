// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/labels/exchange_sides.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace marey::library {
namespace {

using Word = std::string_view;

constexpr std::array<std::pair<Word, Word>, 15> kExchanged{{
    {"left", "right"},
    {"lefts", "rights"},
    {"leftward", "rightward"},
    {"leftwards", "rightwards"},
    {"leftmost", "rightmost"},
    {"lefthand", "righthand"},
    {"lefthanded", "righthanded"},
    {"leftfoot", "rightfoot"},
    {"leftfooted", "rightfooted"},
    {"lefty", "righty"},
    {"leftside", "rightside"},
    {"lefthander", "righthander"},
    {"clockwise", "counterclockwise"},
    {"clockwise", "anticlockwise"},
    {"l", "r"},
}};

// Words that contain the name of a side, but have another meaning.
constexpr std::array<Word, 19> kNoSide{"upright",
                                       "bright",
                                       "brightly",
                                       "brighter",
                                       "fright",
                                       "frightened",
                                       "frighten",
                                       "alright",
                                       "outright",
                                       "aright",
                                       "forthright",
                                       "copyright",
                                       "leftover",
                                       "leftovers",
                                       "cleft",
                                       "birthright",
                                       "wright",
                                       "playwright",
                                       "rightly"};

// Left and right may have another meaning after kBefore or before kAfter.
constexpr std::array<Word, 1> kBefore{"all"};
constexpr std::array<Word, 16> kAfter{"away",
                                      "now",
                                      "after",
                                      "before",
                                      "angle",
                                      "angles",
                                      "the",
                                      "a",
                                      "an",
                                      "behind",
                                      "alone",
                                      "over",
                                      "here",
                                      "there",
                                      "out",
                                      "once"};

struct LabelWord {
  std::size_t start = 0;
  std::size_t size = 0;
  std::string lower;
};

bool is_upper(char c) {
  return c >= 'A' && c <= 'Z';
}
bool is_lower(char c) {
  return c >= 'a' && c <= 'z';
}
char to_lower(char c) {
  return is_upper(c) ? static_cast<char>(c - 'A' + 'a') : c;
}
char to_upper(char c) {
  return is_lower(c) ? static_cast<char>(c - 'a' + 'A') : c;
}

std::vector<LabelWord> words_of(std::string_view label) {
  std::vector<LabelWord> out;
  for (std::size_t k = 0; k < label.size(); ++k) {
    if (!is_lower(label[k]) && !is_upper(label[k])) continue;
    LabelWord word{k, 0, {}};
    for (; k < label.size() && (is_lower(label[k]) || is_upper(label[k])); ++k) {
      if (k > word.start && is_upper(label[k]) && is_lower(label[k - 1])) break;
      word.lower += to_lower(label[k]);
    }
    word.size = k - word.start;
    --k;
    out.push_back(std::move(word));
  }
  return out;
}

template <std::size_t kCount>
bool contains(const std::array<Word, kCount>& list, std::string_view word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

// With the case of the word that it replaces.
std::string in_case_of(std::string_view old, std::string_view lower) {
  std::string out(lower);
  const bool all_upper = std::all_of(old.begin(), old.end(), is_upper);
  for (std::size_t k = 0; k < out.size(); ++k) {
    if (is_upper(old[0]) && (k == 0 || (all_upper && old.size() > 1))) {
      out[k] = to_upper(out[k]);
    }
  }
  return out;
}

bool is_joined(std::string_view label, const LabelWord& word) {
  constexpr std::string_view kJoints = "_.:";
  const std::size_t end = word.start + word.size;
  const bool before =
      word.start > 0 && kJoints.find(label[word.start - 1]) != std::string_view::npos;
  const bool after =
      end < label.size() && kJoints.find(label[end]) != std::string_view::npos;
  return before || after;
}

std::optional<Word> partner_of(std::string_view word) {
  for (const auto& [a, b] : kExchanged) {
    if (word == a) return b;
    if (word == b) return a;
  }
  return std::nullopt;
}

enum class Meaning { kNone, kSide, kUnknown };

Meaning meaning_of(std::string_view label,
                   const std::vector<LabelWord>& words,
                   std::size_t k) {
  const std::string& word = words[k].lower;
  if (word == "l" || word == "r") {
    return is_joined(label, words[k]) ? Meaning::kSide : Meaning::kNone;
  }
  const bool has_before = k > 0;
  if (word == "clockwise" && has_before &&
      (words[k - 1].lower == "counter" || words[k - 1].lower == "anti")) {
    return Meaning::kUnknown;
  }
  if (!partner_of(word)) {
    const bool names_side =
        word.find("left") != std::string::npos || word.find("right") != std::string::npos;
    return names_side && !contains(kNoSide, word) ? Meaning::kUnknown : Meaning::kNone;
  }
  if ((word == "left" || word == "right") && !is_joined(label, words[k])) {
    const bool ambiguous = (has_before && contains(kBefore, words[k - 1].lower)) ||
                           (k + 1 < words.size() && contains(kAfter, words[k + 1].lower));
    if (ambiguous) return Meaning::kUnknown;
  }
  return Meaning::kSide;
}

}  // namespace

std::optional<std::string> exchanged_sides(std::string_view label) {
  const std::vector<LabelWord> words = words_of(label);
  std::string out;
  std::size_t copied = 0;
  for (std::size_t k = 0; k < words.size(); ++k) {
    const Meaning meaning = meaning_of(label, words, k);
    if (meaning == Meaning::kUnknown) return std::nullopt;
    if (meaning == Meaning::kNone) continue;
    const LabelWord& word = words[k];
    out += label.substr(copied, word.start - copied);
    out += in_case_of(label.substr(word.start, word.size), *partner_of(word.lower));
    copied = word.start + word.size;
  }
  out += label.substr(copied);
  return out;
}

}  // namespace marey::library
