// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/verdict_file.h"

#include <algorithm>
#include <array>
#include <system_error>
#include <utility>

#include "core/base/printable.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/number_text.h"
#include "recordings/base/text_reader.h"
#include "recordings/base/word_text.h"
#include "recordings/library/label_table.h"

namespace marey::recordings {
namespace {

constexpr std::array<std::string_view, 6> kVerdictColumns = {
    "clip", "figure", "frames", "verdict", "by", "note"};

enum VerdictColumn : std::size_t { kClip, kFigure, kFrames, kVerdict, kPerson, kNote };

std::optional<Verdict> verdict_named(std::string_view word) {
  for (const Verdict verdict : {Verdict::kPass, Verdict::kWarn, Verdict::kFail}) {
    if (name(verdict) == word) return verdict;
  }
  return std::nullopt;
}

/// Reads "12" or "12-40".
std::optional<FrameRange> frames_of(std::string_view word) {
  const std::size_t mark = word.find('-');
  const auto first = to_integer(word.substr(0, mark));
  const auto last =
      mark == std::string_view::npos ? first : to_integer(word.substr(mark + 1));
  if (!first || !last || *first < 0 || *last < *first) return std::nullopt;
  return FrameRange{*first, *last};
}

VerdictCorrection read_verdict_row(LabelTable& table) {
  VerdictCorrection row;
  row.line = table.line();
  row.clip = table.required(kClip);
  row.figure = table.required(kFigure);
  const std::string frames = table.text(kFrames);
  if (!frames.empty()) {
    row.frames = frames_of(frames);
    if (!row.frames) {
      table.fail(kFrames,
                 "\"frames\" is " + quoted_start(frames),
                 "write the first and the last frame, such as 12-40, or nothing");
    }
  }
  const std::string word = table.required(kVerdict);
  const auto verdict = verdict_named(word);
  if (!verdict) {
    table.fail(
        kVerdict, quoted_start(word) + " is not a verdict", "write pass, warn or fail");
  }
  row.verdict = verdict.value_or(Verdict::kPass);
  row.by = table.text(kPerson);
  row.note = table.text(kNote);
  return row;
}

/// Returns one line of text.
std::string one_line(std::string_view text) {
  std::string out = printable(text);
  std::transform(
      text.begin(), text.end(), out.begin(), out.begin(), [](char was, char is) {
        const auto byte = static_cast<unsigned char>(was);
        return byte < 0x20 || byte == 0x7f ? ' ' : is;
      });
  return out;
}

}  // namespace

Result<std::vector<VerdictCorrection>> parse_verdicts(std::string_view text,
                                                      const std::string& file) {
  LabelTable table(text, file, kVerdictColumns);
  std::vector<VerdictCorrection> out;
  while (table.next()) out.push_back(read_verdict_row(table));
  if (table.mistake()) return *table.mistake();
  return out;
}

Result<std::vector<VerdictCorrection>> read_verdicts(const std::filesystem::path& path) {
  const auto text = read_file(path);
  if (!text) return text.error();
  return parse_verdicts(*text, path.string());
}

std::string verdicts_text(std::span<const VerdictCorrection> rows) {
  std::string out = "clip,figure,frames,verdict,by,note\n";
  for (const VerdictCorrection& row : rows) {
    append_quoted(out, row.clip);
    out += ',';
    append_quoted(out, row.figure);
    out += ',';
    if (row.frames) {
      append_exact(out, row.frames->first);
      out += '-';
      append_exact(out, row.frames->last);
    }
    out += ',';
    out += name(row.verdict);
    out += ',';
    append_quoted(out, row.by);
    out += ',';
    append_quoted(out, row.note);
    out += '\n';
  }
  return out;
}

Status add_verdict(const std::filesystem::path& path, VerdictCorrection correction) {
  std::vector<VerdictCorrection> rows;
  std::error_code failed;
  if (std::filesystem::exists(path, failed)) {
    auto read = read_verdicts(path);
    if (!read) return read.error();
    rows = *std::move(read);
  }
  for (std::string* text :
       {&correction.clip, &correction.figure, &correction.by, &correction.note}) {
    *text = one_line(*text);
  }
  rows.push_back(std::move(correction));
  return write_file(path, verdicts_text(rows));
}

}  // namespace marey::recordings
