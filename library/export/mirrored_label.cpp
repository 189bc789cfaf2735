// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/export/mirrored_label.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include "core/base/lower_case.h"

namespace marey::library {
namespace {

constexpr std::array<std::string_view, 12> kSideEnds{"",
                                                     "ward",
                                                     "wards",
                                                     "hand",
                                                     "handed",
                                                     "foot",
                                                     "footed",
                                                     "leg",
                                                     "arm",
                                                     "side",
                                                     "most",
                                                     "hander"};

constexpr std::array<std::string_view, 22> kWordsWithoutSide{
    "upright",    "uprightly", "bright",     "brightly",   "brighten",  "fright",
    "frighten",   "alright",   "outright",   "forthright", "downright", "copyright",
    "birthright", "rightful",  "rightfully", "righteous",  "rightly",   "leftover",
    "leftovers",  "cleft",     "frightened", "playwright"};

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

bool is_capital(char c) {
  return c >= 'A' && c <= 'Z';
}

/// Returns the end of the word that begins at `begin`.
std::size_t end_of_word(std::string_view text, std::size_t begin) {
  std::size_t end = begin + 1;
  while (end < text.size() && is_letter(text[end]) &&
         !(is_capital(text[end]) && !is_capital(text[end - 1]))) {
    ++end;
  }
  return end;
}

/// Returns `word`, in lower case, on the other side.
std::optional<std::string> other_side(std::string_view word) {
  using Pair = std::array<std::string_view, 2>;
  for (const Pair& side : {Pair{"left", "right"}, Pair{"right", "left"}}) {
    if (!word.starts_with(side[0])) continue;
    const std::string_view rest = word.substr(side[0].size());
    if (std::ranges::find(kSideEnds, rest) == kSideEnds.end()) continue;
    return std::string(side[1]).append(rest);
  }
  if (word == "clockwise") return "counterclockwise";
  if (word == "counterclockwise" || word == "anticlockwise") return "clockwise";
  return std::nullopt;
}

/// Returns `word`, in lower case, with the capitals of `model`.
std::string with_capitals(std::string word, std::string_view model) {
  const auto upper = [](char& c) { c = static_cast<char>(c - 'a' + 'A'); };
  if (model.size() > 1 && std::ranges::all_of(model, is_capital)) {
    std::ranges::for_each(word, upper);
  } else if (is_capital(model.front())) {
    upper(word.front());
  }
  return word;
}

bool names_side(std::string_view word) {
  return word.find("left") != std::string_view::npos ||
         word.find("right") != std::string_view::npos;
}

}  // namespace

MirroredLabel mirrored_label(std::string_view label) {
  MirroredLabel out;
  for (std::size_t i = 0; i < label.size();) {
    if (!is_letter(label[i])) {
      out.text += label[i++];
      continue;
    }
    const std::size_t end = end_of_word(label, i);
    const std::string_view word = label.substr(i, end - i);
    const std::string lower = lower_case(word);
    i = end;
    if (const auto other = other_side(lower)) {
      out.text += with_capitals(*other, word);
      continue;
    }
    out.text += word;
    const bool is_neutral =
        std::ranges::find(kWordsWithoutSide, lower) != kWordsWithoutSide.end();
    if (names_side(lower) && !is_neutral) out.unknown_word = word;
  }
  if (!out.unknown_word.empty()) out.text = label;
  return out;
}

}  // namespace marey::library
