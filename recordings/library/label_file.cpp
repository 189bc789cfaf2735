// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/label_file.h"

#include <array>
#include <utility>

#include "recordings/base/atomic_file.h"
#include "recordings/base/number_text.h"
#include "recordings/library/label_table.h"

namespace marey::recordings {
namespace {

constexpr std::array<std::string_view, 6> kLabelColumns = {
    "clip_or_source", "start_s", "end_s", "label", "by", "sure"};
/// A day.
constexpr double kMaxLabel_s = 86400.0;

enum LabelColumn : std::size_t { kTarget, kStart, kEnd, kText, kBy, kSure };

LabelRow read_label_row(LabelTable& table, const std::string& by) {
  LabelRow row;
  row.line = table.line();
  row.target = table.required(kTarget);
  row.start_s = table.number(kStart, 0.0, kMaxLabel_s);
  row.end_s = table.number(kEnd, 0.0, kMaxLabel_s);
  row.text = table.required(kText);
  row.by = table.text(kBy);
  if (row.by.empty()) row.by = by;
  row.certainty = table.number(kSure, 0.0, 1.0).value_or(1.0);
  if (row.end_s && *row.end_s < row.start_s.value_or(0.0)) {
    table.fail(kEnd, "the label ends before it starts", "exchange start_s and end_s");
  }
  if (row.by == "marey") {
    table.fail(kBy,
               "\"marey\" is the name of labels that a build makes",
               "write the name of the person or the table, or remove the line");
  }
  return row;
}

void append_time(std::string& text, const std::optional<double>& time_s) {
  text += ',';
  if (time_s) append_exact(text, *time_s);
}

}  // namespace

Result<std::vector<LabelRow>> parse_labels(std::string_view text,
                                           const std::string& file,
                                           const std::string& by) {
  LabelTable table(text, file, kLabelColumns);
  std::vector<LabelRow> out;
  while (table.next()) out.push_back(read_label_row(table, by));
  if (table.mistake()) return *table.mistake();
  return out;
}

Result<std::vector<LabelRow>> read_labels(const std::filesystem::path& path) {
  const auto text = read_file(path);
  if (!text) return text.error();
  return parse_labels(*text, path.string(), path.stem().string());
}

std::string labels_text(std::span<const LabelRow> rows) {
  std::string out = "clip_or_source,start_s,end_s,label,by,sure\n";
  for (const LabelRow& row : rows) {
    append_quoted(out, row.target);
    append_time(out, row.start_s);
    append_time(out, row.end_s);
    out += ',';
    append_quoted(out, row.text);
    out += ',';
    append_quoted(out, row.by);
    out += ',';
    append_exact(out, row.certainty);
    out += '\n';
  }
  return out;
}

}  // namespace marey::recordings
