// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/sources/index_table.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <set>
#include <system_error>
#include <utility>

#include "app/library/sources/index_columns.h"
#include "app/library/sources/source_kind.h"
#include "core/base/in_quotes.h"
#include "core/base/lower_case.h"
#include "core/base/printable.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/motion_limits.h"
#include "recordings/base/table_cells.h"

namespace marey::app {
namespace {

/// Returns the text without leading zeros, if it is a number; else the text.
std::string without_zeros(std::string_view text) {
  if (!std::ranges::all_of(text, is_ascii_digit)) return std::string(text);
  const std::size_t first = text.find_first_not_of('0');
  return first == std::string_view::npos ? "0" : std::string(text.substr(first));
}

/// Returns the key of "SUBJECT_TRIAL".
std::string trial_key(std::string_view subject, std::string_view trial) {
  return without_zeros(subject) + "_" + without_zeros(trial);
}

/// Splits a line into cells, which may be in double quotes. Returns the number of the
/// first column, from 1, whose quote is not closed; 0: all are.
std::size_t split_quoted(std::string_view line,
                         char mark,
                         std::vector<std::string>& cells) {
  cells.assign(1, "");
  bool is_quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (is_quoted) {
      const bool is_escape = c == '"' && i + 1 < line.size() && line[i + 1] == '"';
      if (c != '"' || is_escape) cells.back() += c;
      if (is_escape) ++i;
      if (c == '"' && !is_escape) is_quoted = false;
    } else if (c == '"' && recordings::trimmed(cells.back()).empty()) {
      cells.back().clear();
      is_quoted = true;
    } else if (c == mark) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  for (std::string& cell : cells) cell = std::string(recordings::trimmed(cell));
  return is_quoted ? cells.size() : 0;
}

/// Returns the words of four letters or more, in lower case.
std::set<std::string> long_words(std::string_view text) {
  constexpr std::size_t kMinLetters = 4;
  std::set<std::string> out;
  std::string word;
  const auto end_word = [&] {
    if (word.size() >= kMinLetters) out.insert(word);
    word.clear();
  };
  for (const char c : text) {
    if (is_ascii_letter(c)) {
      word += lower_case(c);
    } else {
      end_word();
    }
  }
  end_word();
  return out;
}

bool is_same_statement(const IndexEntry& a, const IndexEntry& b) {
  return a.rate_hz == b.rate_hz && a.description == b.description &&
         a.labels == b.labels && a.subject == b.subject;
}

}  // namespace

/// Reads a table line by line.
class IndexReader {
 public:
  IndexReader(std::string_view text, std::string file) : lines_(text) {
    out_.file_ = std::move(file);
  }

  Result<IndexTable> read() {
    if (const Status ok = read_header(); !ok) return ok.error();
    while (const auto line = lines_.next()) {
      if (recordings::trimmed(*line).empty()) continue;
      if (const Status ok = read_row(*line); !ok) return ok.error();
    }
    return std::move(out_);
  }

 private:
  [[nodiscard]] Error fail(std::string cause, std::string next) const {
    const int line = std::max(lines_.line(), 1);
    return bad_input(
        out_.file_ + ":" + std::to_string(line), std::move(cause), std::move(next));
  }

  Status split(std::string_view line) {
    const std::size_t open = split_quoted(line, mark_, cells_);
    if (open == 0) return Done{};
    return fail("column " + std::to_string(open) + ": a quote is not closed",
                "write \" at the end of the cell, and \"\" for a quote within it");
  }

  Status read_header() {
    auto line = lines_.next();
    if (!line || recordings::trimmed(*line).empty()) {
      return fail("the table has no first line with names of columns",
                  "write one, such as: file,rate_hz,description,labels,subject");
    }
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (line->starts_with(kByteOrderMark)) line->remove_prefix(kByteOrderMark.size());
    mark_ = ',';
    for (const char mark : {';', '\t'}) {
      if (line->find(',') == std::string_view::npos &&
          line->find(mark) != std::string_view::npos) {
        mark_ = mark;
      }
    }
    if (const Status ok = split(*line); !ok) return ok;
    headers_ = cells_;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      const auto column = column_of(cells_[i]);
      columns_.push_back(column);
      if (!column) continue;
      if (!found_.insert(*column).second) {
        return fail("column " + std::to_string(i + 1) + ": " +
                        in_quotes(printable(cells_[i])) +
                        " means the same as an earlier column",
                    "rename or remove one of them");
      }
    }
    return check_columns();
  }

  Status check_columns() const {
    const bool has_trials =
        found_.contains(IndexColumn::kSubject) && found_.contains(IndexColumn::kTrial);
    if (!found_.contains(IndexColumn::kFile) && !has_trials) {
      return fail("no column names the files",
                  "name a column \"file\", or two columns \"subject\" and \"trial\"");
    }
    const bool has_statement = found_.contains(IndexColumn::kRate) ||
                               found_.contains(IndexColumn::kDescription) ||
                               found_.contains(IndexColumn::kLabels) ||
                               (!has_trials && found_.contains(IndexColumn::kSubject));
    if (has_statement) return Done{};
    return fail("no column states anything about the files",
                "name a column \"rate_hz\", \"description\", \"labels\" or \"subject\"");
  }

  [[nodiscard]] std::string cell(IndexColumn wanted) const {
    for (std::size_t i = 0; i < std::min(cells_.size(), columns_.size()); ++i) {
      if (columns_[i] == wanted) return printable(cells_[i]);
    }
    return {};
  }

  [[nodiscard]] std::string place_of(IndexColumn wanted) const {
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (columns_[i] != wanted) continue;
      return "column " + std::to_string(i + 1) + " (" + printable(headers_[i]) + ")";
    }
    return "the line";
  }

  Status read_rate(IndexEntry& entry) const {
    const std::string text = cell(IndexColumn::kRate);
    if (text.empty()) return Done{};
    double rate_hz = 0.0;
    const char* end = text.data() + text.size();
    const auto [stop, problem] = std::from_chars(text.data(), end, rate_hz);
    const bool is_rate = problem == std::errc{} && stop == end &&
                         rate_hz >= recordings::kMinRateHz &&
                         rate_hz <= recordings::kMaxRateHz;
    if (!is_rate) {
      return fail(place_of(IndexColumn::kRate) + ": " + in_quotes(text) +
                      " is not a frame rate from 0.1 to 2000 Hz",
                  "correct the rate, or leave the cell empty");
    }
    entry.rate_hz = rate_hz;
    return Done{};
  }

  /// A duration that is no number is left out: it only helps to choose a rate.
  void read_duration(IndexEntry& entry) const {
    const std::string text = cell(IndexColumn::kDuration);
    double value = 0.0;
    const char* end = text.data() + text.size();
    const auto [stop, problem] = std::from_chars(text.data(), end, value);
    if (problem != std::errc{} || stop != end || !(value > 0.0)) return;
    const auto column = std::ranges::find(columns_, IndexColumn::kDuration);
    const double hz =
        counted_rate_hz(headers_[static_cast<std::size_t>(column - columns_.begin())]);
    entry.duration_s = hz > 0.0 ? value / hz : value;
  }

  Status read_row(std::string_view line) {
    if (const Status ok = split(line); !ok) return ok;
    while (cells_.size() > columns_.size() && cells_.back().empty()) cells_.pop_back();
    if (cells_.size() > columns_.size()) {
      return fail("column " + std::to_string(columns_.size() + 1) + ": the line has " +
                      std::to_string(cells_.size()) + " cells, but the table has " +
                      std::to_string(columns_.size()) + " columns",
                  "put text with the separator of cells in double quotes");
    }
    IndexEntry entry;
    entry.line = lines_.line();
    entry.evidence = "line " + std::to_string(entry.line) + " of " +
                     std::filesystem::path(out_.file_).filename().string();
    entry.description = cell(IndexColumn::kDescription);
    entry.subject = cell(IndexColumn::kSubject);
    read_labels(entry);
    read_duration(entry);
    if (const Status ok = read_rate(entry); !ok) return ok;
    return add(std::move(entry));
  }

  void read_labels(IndexEntry& entry) const {
    const std::string text = cell(IndexColumn::kLabels);
    for (std::size_t at = 0; at <= text.size();) {
      const std::size_t end = std::min(text.find(';', at), text.size());
      const auto label = recordings::trimmed(std::string_view(text).substr(at, end - at));
      if (!label.empty()) entry.labels.emplace_back(label);
      at = end + 1;
    }
  }

  Status add(IndexEntry entry) {
    const std::string file = cell(IndexColumn::kFile);
    const std::string trial = cell(IndexColumn::kTrial);
    const bool is_by_file = found_.contains(IndexColumn::kFile);
    if (is_by_file ? file.empty() : (entry.subject.empty() || trial.empty())) {
      return fail(place_of(is_by_file              ? IndexColumn::kFile
                           : entry.subject.empty() ? IndexColumn::kSubject
                                                   : IndexColumn::kTrial) +
                      " is empty",
                  "name the file, or remove the line");
    }
    auto& names = is_by_file ? out_.by_name_ : out_.by_trial_;
    const std::string key = is_by_file ? file : trial_key(entry.subject, trial);
    const auto [known, is_new] = names.emplace(key, out_.entries_.size());
    if (!is_new) {
      const IndexEntry& first = out_.entries_[known->second];
      if (is_same_statement(first, entry)) return Done{};
      return fail(place_of(is_by_file ? IndexColumn::kFile : IndexColumn::kTrial) + ": " +
                      in_quotes(key) + " is also in line " + std::to_string(first.line) +
                      ", with other content",
                  "remove one of the two lines");
    }
    out_.words_.push_back(long_words(entry.description));
    out_.entries_.push_back(std::move(entry));
    return Done{};
  }

  recordings::LineReader lines_;
  char mark_ = ',';
  std::vector<std::string> cells_;
  std::vector<std::string> headers_;
  std::vector<std::optional<IndexColumn>> columns_;
  std::set<IndexColumn> found_;
  IndexTable out_;
};

Result<IndexTable> IndexTable::parse(std::string_view text, const std::string& file) {
  return IndexReader(text, file).read();
}

Result<IndexTable> IndexTable::read(const std::filesystem::path& path) {
  const auto text = recordings::read_file(path);
  if (!text) return text.error();
  return parse(*text, path.string());
}

std::optional<IndexEntry> IndexTable::find(const SourceFile& file) const {
  const std::string stem = source_stem(file.name, file.kind);
  const std::string base = std::filesystem::path(file.name).filename().string();
  const std::string path =
      std::filesystem::path(file.name).replace_extension().generic_string();
  for (const std::string& name : {file.name, path, base, stem}) {
    const auto found = by_name_.find(name);
    if (found != by_name_.end()) return entries_[found->second];
  }
  const std::size_t mark = stem.rfind('_');
  if (mark != std::string::npos) {
    const auto found =
        by_trial_.find(trial_key(stem.substr(0, mark), stem.substr(mark + 1)));
    if (found != by_trial_.end()) return entries_[found->second];
  }
  const std::set<std::string> words = long_words(stem);
  if (words.empty()) return std::nullopt;
  IndexEntry out;
  std::size_t lines = 0;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const IndexEntry& entry = entries_[i];
    if (!entry.rate_hz || !std::ranges::includes(words_[i], words)) continue;
    if (lines > 0 && out.rate_hz != entry.rate_hz) return std::nullopt;
    out.rate_hz = entry.rate_hz;
    ++lines;
  }
  if (lines == 0) return std::nullopt;
  std::string quoted;
  for (const std::string& word : words) quoted += (quoted.empty() ? "" : " ") + word;
  out.evidence = std::to_string(lines) + (lines == 1 ? " line" : " lines") + " of " +
                 std::filesystem::path(file_).filename().string() + " with " +
                 in_quotes(quoted);
  return out;
}

std::vector<ClipLabel> labels_of_index(const IndexEntry& entry, double duration_s) {
  std::set<std::string> texts(entry.labels.begin(), entry.labels.end());
  if (!entry.description.empty()) texts.insert(entry.description);
  std::vector<ClipLabel> out;
  for (const std::string& text : texts) {
    out.push_back({0.0, duration_s, text, "index", 1.0});
  }
  return out;
}

}  // namespace marey::app
