// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/nearest_word.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/base/assert.h"
#include "core/base/lower_case.h"
#include "core/humanoid.h"

namespace marey {
namespace {

// All costs are times four, so that a change of case can cost a quarter of a letter.
constexpr std::size_t kLetter = 4;

constexpr std::size_t kMaxWordLength = 64;  // No key is longer; keeps the search cheap.

std::size_t cost_of_change(char a, char b) {
  if (a == b) return 0;
  return lower_case(a) == lower_case(b) ? kLetter / 4 : kLetter;
}

std::size_t distance(std::string_view a, std::string_view b) {
  b = b.substr(0, kMaxWordLength);
  // Distance from a's first i letters to b's first j.
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j * kLetter;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i * kLetter;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t changed = diagonal + cost_of_change(a[i - 1], b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({changed, row[j] + kLetter, row[j - 1] + kLetter});
    }
  }
  return row[b.size()];
}

/// Returns the nearest word. Precondition: `words` not empty.
std::string_view nearest(std::string_view wrong,
                         std::span<const std::string_view> words) {
  return *std::min_element(words.begin(), words.end(), [&](auto a, auto b) {
    return distance(wrong, a) < distance(wrong, b);
  });
}

/// Returns true if at most 40 % of the letters differ.
bool is_near(std::string_view wrong, std::string_view word) {
  const std::size_t letters = std::max(wrong.size(), word.size());
  return 5 * distance(wrong, word) <= 2 * kLetter * letters;
}

}  // namespace

std::string suggestion(std::string_view wrong, std::span<const std::string_view> words) {
  MAREY_ASSERT(!words.empty());
  wrong = wrong.substr(0, kMaxWordLength);
  const std::string_view found = nearest(wrong, words);
  if (is_near(wrong, found)) {
    return std::string("perhaps you mean \"")
        .append(found.substr(0, kMaxWordLength))
        .append("\"");
  }
  std::string text = "choose one of ";
  for (std::size_t i = 0; i < words.size(); ++i) {
    text.append(i == 0 ? "\"" : ", \"")
        .append(words[i].substr(0, kMaxWordLength))
        .append("\"");
  }
  return text;
}

std::optional<std::string_view> meant_word(std::string_view wrong,
                                           std::span<const std::string_view> words) {
  if (words.empty()) return std::nullopt;
  wrong = wrong.substr(0, kMaxWordLength);
  const std::string_view found = nearest(wrong, words);
  if (is_near(wrong, found) && distance(wrong, found) <= 2 * kLetter) return found;
  constexpr std::size_t kMinBeginning = 3;
  const auto begins = std::find_if(words.begin(), words.end(), [&](auto word) {
    const bool is_long = std::min(word.size(), wrong.size()) >= kMinBeginning;
    return is_long && (word.starts_with(wrong) || wrong.starts_with(word));
  });
  if (begins == words.end()) return std::nullopt;
  return *begins;
}

std::vector<std::string_view> nearest_words(std::string_view wrong,
                                            std::span<const std::string_view> words,
                                            std::size_t count) {
  wrong = wrong.substr(0, kMaxWordLength);
  // Each distance is computed once: a body may have thousands of joints.
  std::vector<std::pair<std::size_t, std::string_view>> ranked;
  for (const std::string_view word : words)
    ranked.emplace_back(distance(wrong, word), word);
  std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) {
    return a.first < b.first;
  });
  if (ranked.size() > count) ranked.resize(count);
  std::vector<std::string_view> nearest;
  for (const auto& [letters, word] : ranked) nearest.push_back(word);
  return nearest;
}

std::string bone_suggestion(std::string_view wrong) {
  std::vector<std::string_view> names;
  for (const HumanBone bone : human_bones()) names.push_back(name(bone));
  return suggestion(wrong, names);
}

}  // namespace marey
