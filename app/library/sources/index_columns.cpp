// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/sources/index_columns.h"

#include <array>
#include <cstddef>
#include <string>
#include <utility>

#include "core/base/lower_case.h"

namespace marey::app {
namespace {

/// Words of columns, in lower case without blanks and punctuation.
constexpr std::array<std::pair<std::string_view, IndexColumn>, 25> kColumnWords{{
    {"file", IndexColumn::kFile},
    {"filename", IndexColumn::kFile},
    {"name", IndexColumn::kFile},
    {"clip", IndexColumn::kFile},
    {"path", IndexColumn::kFile},
    {"subject", IndexColumn::kSubject},
    {"actor", IndexColumn::kSubject},
    {"performer", IndexColumn::kSubject},
    {"person", IndexColumn::kSubject},
    {"trial", IndexColumn::kTrial},
    {"take", IndexColumn::kTrial},
    {"ratehz", IndexColumn::kRate},
    {"rate", IndexColumn::kRate},
    {"fps", IndexColumn::kRate},
    {"hz", IndexColumn::kRate},
    {"framerate", IndexColumn::kRate},
    {"frameratehz", IndexColumn::kRate},
    {"description", IndexColumn::kDescription},
    {"motiondescription", IndexColumn::kDescription},
    {"motion", IndexColumn::kDescription},
    {"labels", IndexColumn::kLabels},
    {"label", IndexColumn::kLabels},
    {"duration", IndexColumn::kDuration},
    {"durations", IndexColumn::kDuration},
    {"seconds", IndexColumn::kDuration},
}};

}  // namespace

double counted_rate_hz(std::string_view header) {
  std::string word;
  std::string digits;
  for (const char c : header) {
    if (is_ascii_letter(c)) word += lower_case(c);
    if (is_ascii_digit(c)) digits += c;
  }
  constexpr std::size_t kMaxDigits = 4;
  const bool counts = word == "framesfps" || word == "frameshz";
  if (!counts || digits.empty() || digits.size() > kMaxDigits) return 0.0;
  return std::stod(digits);
}

std::optional<IndexColumn> column_of(std::string_view header) {
  std::string word;
  for (const char c : header) {
    if (is_ascii_letter(c) || is_ascii_digit(c)) word += lower_case(c);
  }
  for (const auto& [known, column] : kColumnWords) {
    if (known == word) return column;
  }
  if (counted_rate_hz(header) > 0.0) return IndexColumn::kDuration;
  return std::nullopt;
}

}  // namespace marey::app
