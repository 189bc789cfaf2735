// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/print/print_words.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "core/base/in_quotes.h"
#include "core/base/lower_case.h"
#include "core/nearest_word.h"
#include "recordings/base/word_text.h"

namespace marey::recordings {
namespace {

constexpr double kMaxLength_m = 10.0;
constexpr int kMaxTags = 2000;
constexpr const char* kIdsNext =
    "write ids as 40-75,90 or with segments: 41:hips,73:head";

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

/// Splits a text into its leading number and the rest.
std::optional<std::pair<double, std::string_view>> number_and_rest(
    std::string_view text) {
  double value = 0.0;
  const auto [end, problem] =
      std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc{} || !std::isfinite(value)) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return std::pair(value, trimmed(text));
}

/// Divides where that is exact: 18 mm are exactly 0.018 m.
std::optional<double> metres(double value, std::string_view unit) {
  constexpr std::array<std::pair<std::string_view, double>, 4> kUnits{
      {{"mm", 1000.0}, {"cm", 100.0}, {"in", 10000.0 / 254.0}, {"m", 1.0}}};
  for (const auto& [name, in_a_metre] : kUnits) {
    if (unit == name) return value / in_a_metre;
  }
  return std::nullopt;
}

std::optional<int> id_of(std::string_view text) {
  text = trimmed(text);
  int id = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), id);
  if (problem != std::errc{} || end != text.data() + text.size() || id < 0) {
    return std::nullopt;
  }
  return id;
}

/// Parses "40" or "40-75", each optionally with ":hips".
Result<std::vector<NamedTag>> parse_item(std::string_view item) {
  const std::size_t colon = item.find(':');
  std::optional<HumanBone> segment;
  if (colon != std::string_view::npos) {
    const std::string_view word = trimmed(item.substr(colon + 1));
    segment = human_bone(word);
    if (!segment) {
      return bad_input(
          "ids", "unknown segment " + in_quotes(word), bone_suggestion(word));
    }
  }
  const std::string_view ids = item.substr(0, colon);
  const std::size_t dash = ids.find('-');
  const auto first = id_of(ids.substr(0, dash));
  const auto last = dash == std::string_view::npos ? first : id_of(ids.substr(dash + 1));
  if (!first || !last) {
    return bad_input(
        "ids", in_quotes(item) + " is not an id or a range of ids", kIdsNext);
  }
  if (*last < *first) {
    return bad_input("ids",
                     in_quotes(item) + " goes down",
                     "write " + std::to_string(*last) + "-" + std::to_string(*first));
  }
  if (*last - *first >= kMaxTags) {
    return bad_input(
        "ids",
        in_quotes(item) + " are more than " + std::to_string(kMaxTags) + " tags",
        "print fewer at once");
  }
  std::vector<NamedTag> tags;
  for (int id = *first; id <= *last; ++id) tags.push_back({TagId{id}, segment});
  return tags;
}

}  // namespace

Result<double> parse_length_m(std::string_view text) {
  const auto parsed = number_and_rest(trimmed(text));
  if (!parsed) {
    return bad_input("length",
                     in_quotes(text) + " is not a length",
                     "write for example 80mm, 8cm or 3.15in");
  }
  const auto [value, unit] = *parsed;
  const std::string digits(trimmed(text).substr(0, trimmed(text).size() - unit.size()));
  if (unit.empty()) {
    return bad_input("length",
                     in_quotes(text) + " has no unit",
                     "write " + digits + "mm, " + digits + "cm or " + digits + "in");
  }
  const auto length_m = metres(value, unit);
  if (!length_m) {
    return bad_input("length",
                     "unknown unit " + in_quotes(unit) + " in " + in_quotes(text),
                     "use mm, cm or in");
  }
  if (!(*length_m > 0.0 && *length_m <= kMaxLength_m)) {
    return bad_input("length",
                     in_quotes(text) + " must be above 0 and at most 10 m",
                     "check number and unit");
  }
  return *length_m;
}

Result<Paper> parse_paper(std::string_view text) {
  constexpr double kMaxEdge_m = 5.0;
  const std::string word = lower_case(trimmed(text));
  if (word == "a4") return Paper{"A4", 0.210, 0.297};
  if (word == "a3") return Paper{"A3", 0.297, 0.420};
  if (word == "letter") return Paper{"Letter", 0.2159, 0.2794};
  const auto width = number_and_rest(word);
  if (width && width->second.starts_with('x')) {
    const auto height = number_and_rest(trimmed(width->second.substr(1)));
    const auto width_m =
        height ? metres(width->first, height->second) : std::optional<double>{};
    const auto height_m =
        height ? metres(height->first, height->second) : std::optional<double>{};
    if (width_m && std::min(*width_m, *height_m) > 0.0 &&
        std::max(*width_m, *height_m) <= kMaxEdge_m) {
      return Paper{word, *width_m, *height_m};
    }
  }
  return bad_input("page",
                   in_quotes(text) + " is not a page size",
                   "write A4, A3, Letter, or width and height as 210x297mm");
}

Result<std::vector<NamedTag>> parse_tags(std::string_view text) {
  std::vector<NamedTag> tags;
  std::set<TagId> taken;
  for (std::string_view rest = text;;) {
    const std::size_t comma = rest.find(',');
    const auto item = parse_item(trimmed(rest.substr(0, comma)));
    if (!item) return item.error();
    for (const NamedTag& tag : *item) {
      if (taken.insert(tag.id).second) {
        tags.push_back(tag);
        continue;
      }
      return bad_input("ids",
                       "tag " + std::to_string(number(tag.id)) + " is given twice",
                       "name each tag once");
    }
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  return tags;
}

}  // namespace marey::recordings
