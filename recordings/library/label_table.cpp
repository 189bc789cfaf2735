// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/label_table.h"

#include <utility>

#include "core/base/in_quotes.h"
#include "core/base/printable.h"
#include "recordings/base/text_reader.h"
#include "recordings/base/word_text.h"

namespace marey::recordings {

LabelTable::LabelTable(std::string_view text,
                       std::string file,
                       std::span<const std::string_view> header)
    : lines_(text), file_(std::move(file)), header_(header) {
  read_header();
}

std::string LabelTable::header_line() const {
  std::string out;
  for (const std::string_view title : header_) {
    if (!out.empty()) out += ',';
    out += title;
  }
  return out;
}

void LabelTable::read_header() {
  const auto line = lines_.next();
  const std::string expected = header_line();
  const std::string next_step = "write the first line as " + expected;
  if (!line) return fail_at("", "the table is empty", next_step);
  const bool has_titles = split_quoted(*line, cells_) == 0;
  bool is_same = has_titles && cells_.size() == header_.size();
  for (std::size_t i = 0; is_same && i < header_.size(); ++i) {
    is_same = text(i) == header_[i];
  }
  if (is_same) return;
  const bool has_other_mark = line->find(',') == std::string_view::npos &&
                              line->find_first_of(";\t") != std::string_view::npos;
  fail_at(":1",
          "the first line " + quoted_start(*line) + " is not " + expected,
          has_other_mark ? "save the table with commas between the cells" : next_step);
}

bool LabelTable::next() {
  while (!mistake_) {
    const auto line = lines_.next();
    if (!line) return false;
    if (trimmed(*line).empty()) continue;
    const std::size_t wrong = split_quoted(*line, cells_);
    if (wrong != 0) {
      fail_at(with_number(with_number(":", lines_.line()) + ":", static_cast<int>(wrong)),
              "a quote is not closed, or text follows it",
              "write a quote inside a cell twice, and the cell in quotes");
    } else if (cells_.size() != header_.size()) {
      fail_at(with_number(":", lines_.line()),
              with_number("the line has ", static_cast<int>(cells_.size())) +
                  with_number(" cells instead of ", static_cast<int>(header_.size())),
              "put texts that have a comma into quotes");
    }
    for (std::size_t i = 0; !mistake_ && i < cells_.size(); ++i) {
      if (printable(cells_[i].text) != cells_[i].text) {
        fail(i, "the cell has bytes that are no text", "save the table as UTF-8");
      }
    }
    return !mistake_;
  }
  return false;
}

std::string LabelTable::text(std::size_t column) const {
  return mistake_ ? std::string() : std::string(trimmed(cells_[column].text));
}

std::string LabelTable::required(std::size_t column) {
  std::string out = text(column);
  if (out.empty()) {
    fail(column,
         in_quotes(header_[column]) + " is empty",
         "fill the cell, or remove the line");
  }
  return out;
}

std::optional<double> LabelTable::number(std::size_t column, double min, double max) {
  const std::string word = text(column);
  if (word.empty()) return std::nullopt;
  const auto value = to_number(word);
  if (value && *value >= min && *value <= max) return value;
  std::string range = "write a number from ";
  append_exact(range, min);
  range += " to ";
  append_exact(range, max);
  fail(column,
       in_quotes(header_[column]) + " is " + quoted_start(word) +
           (value ? ", which is out of its range" : ", which is not a number"),
       range);
  return std::nullopt;
}

void LabelTable::fail(std::size_t column, std::string cause, std::string next_step) {
  if (mistake_) return;
  const auto place = static_cast<int>(cells_[column].column);
  fail_at(with_number(with_number(":", lines_.line()) + ":", place),
          std::move(cause),
          std::move(next_step));
}

void LabelTable::fail_at(std::string place, std::string cause, std::string next_step) {
  if (mistake_) return;
  mistake_ = bad_input(file_ + place, std::move(cause), std::move(next_step));
}

}  // namespace marey::recordings
