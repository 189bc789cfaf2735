// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/select_clips.h"

#include <cstdint>
#include <utility>
#include <variant>

#include "recordings/base/sqlite.h"
#include "recordings/library/open_index.h"

namespace marey::recordings {
namespace {

namespace fs = std::filesystem;

using IndexValue = std::variant<std::string_view, double>;

std::string_view operator_of(Comparison comparison) {
  constexpr std::string_view kOperators[] = {"=", "<>", "<", "<=", ">", ">="};
  return kOperators[static_cast<int>(comparison)];
}

/// Returns the column of a text, and whether it is one of the source.
std::pair<std::string_view, bool> column_of(ClipText which) {
  constexpr std::pair<std::string_view, bool> kColumns[] = {{"clip.id", false},
                                                            {"clip.name", false},
                                                            {"source.path", true},
                                                            {"source.kind", true},
                                                            {"clip.licence", false},
                                                            {"source.origin", true},
                                                            {"clip.subject", false},
                                                            {"clip.split", false},
                                                            {"clip.body", false},
                                                            {"clip.rate_by", false},
                                                            {"clip.duplicate_of", false},
                                                            {"clip.mirror_of", false}};
  return kColumns[static_cast<int>(which)];
}

std::string_view word_of(WordKind kind) {
  constexpr std::string_view kWords[] = {
      "figure", "label", "event", "problem", "kind", "licence", "subject", "split"};
  return kWords[static_cast<int>(kind)];
}

/// Returns the statement for the clips whose text fulfils `condition`, which has {} for
/// the text.
std::string select_by_text(ClipText which,
                           std::string_view before,
                           std::string_view after) {
  const auto [column, is_of_source] = column_of(which);
  std::string condition(before);
  condition.append(column).append(after);
  if (!is_of_source) return "SELECT number FROM clip WHERE " + condition;
  return "SELECT number FROM clip WHERE source IN (SELECT id FROM source WHERE " +
         condition + ")";
}

}  // namespace

class ClipSelector::Index {
 public:
  Index(fs::path path, Database database, int clips)
      : path_(std::move(path)),
        database_(std::move(database)),
        max_rows_(max_rows(path_)),
        clips_(clips) {}

  [[nodiscard]] int clips() const { return clips_; }

  [[nodiscard]] Result<ClipSet> select(const std::string& sql,
                                       std::span<const IndexValue> values) const {
    ClipSet out(static_cast<std::size_t>(clips_));
    bool is_known = true;
    const Status ok = each_row(sql, values, [&](const Statement& row) {
      const std::int64_t number = row.integer(0);
      if (number >= 0 && number < clips_) {
        out[static_cast<std::size_t>(number)] = true;
      } else {
        is_known = false;
      }
    });
    if (!ok) return ok.error();
    if (!is_known) return bad_index(path_, "it is damaged: numbers of clips are wrong");
    return out;
  }

  template <class Read>
  Status each_row(const std::string& sql,
                  std::span<const IndexValue> values,
                  const Read& read) const {
    Statement query(database_.get(), sql);
    int place = 0;
    for (const IndexValue& value : values) {
      std::visit([&](const auto& bound) { query.bind(place++, bound); }, value);
    }
    // Pages of a damaged file may refer to each other in a circle.
    for (std::int64_t rows = 0; query.next_row(); ++rows) {
      if (rows >= max_rows_) return bad_index(path_, "it is damaged: its rows never end");
      read(query);
    }
    if (!query.failed()) return Done{};
    return bad_index(path_,
                     std::string("it is damaged: ") + sqlite3_errmsg(database_.get()));
  }

 private:
  fs::path path_;
  Database database_;
  std::int64_t max_rows_ = 0;
  int clips_ = 0;
};

ClipSelector::ClipSelector(std::unique_ptr<Index> index) : index_(std::move(index)) {}
ClipSelector::ClipSelector(ClipSelector&& other) noexcept = default;
ClipSelector::~ClipSelector() = default;

Result<ClipSelector> ClipSelector::open(const fs::path& index) {
  auto database = open_index(index);
  if (!database) return database.error();
  const auto clips = count_clips(index, database->get());
  if (!clips) return clips.error();
  return ClipSelector(std::make_unique<Index>(index, *std::move(database), *clips));
}

int ClipSelector::clip_count() const {
  return index_->clips();
}

Result<std::vector<std::string>> ClipSelector::words(WordKind kind) const {
  std::vector<std::string> out;
  const IndexValue values[] = {word_of(kind)};
  const Status ok =
      index_->each_row("SELECT word FROM vocabulary WHERE kind = ? ORDER BY word",
                       values,
                       [&](const Statement& row) { out.push_back(row.text(0)); });
  if (!ok) return ok.error();
  return out;
}

Result<ClipSet> ClipSelector::with_text(ClipText which, std::string_view value) const {
  const IndexValue values[] = {value};
  return index_->select(select_by_text(which, "", " = ?"), values);
}

Result<ClipSet> ClipSelector::with_part_of_text(ClipText which,
                                                std::string_view part) const {
  const IndexValue values[] = {part};
  return index_->select(select_by_text(which, "instr(lower(", "), lower(?)) > 0"),
                        values);
}

Result<ClipSet> ClipSelector::with_number(ClipNumber which,
                                          Comparison comparison,
                                          double value) const {
  constexpr std::string_view kColumns[] = {"seconds", "rate_hz", "last - first + 1"};
  std::string sql = "SELECT number FROM clip WHERE ";
  sql.append(kColumns[static_cast<int>(which)]).append(1, ' ');
  sql.append(operator_of(comparison)).append(" ?");
  const IndexValue values[] = {value};
  return index_->select(sql, values);
}

Result<ClipSet> ClipSelector::with_figure(std::string_view name,
                                          Comparison comparison,
                                          double value) const {
  std::string sql = "SELECT clip FROM figure WHERE name = ? AND value ";
  sql.append(operator_of(comparison)).append(" ?");
  const IndexValue values[] = {name, value};
  return index_->select(sql, values);
}

Result<ClipSet> ClipSelector::with_label(std::string_view text, double min_s) const {
  // Times of labels are multiples of a frame's time, and so are their differences, but
  // for rounding.
  constexpr double kRounding_s = 1e-6;
  const IndexValue values[] = {text, min_s - kRounding_s};
  return index_->select("SELECT clip FROM label WHERE name = ? AND b - a >= ?", values);
}

Result<ClipSet> ClipSelector::with_part_of_label(std::string_view part,
                                                 std::string_view beginning) const {
  const IndexValue values[] = {beginning, beginning, beginning, part};
  return index_->select(
      "SELECT clip FROM label WHERE name IN (SELECT word FROM vocabulary WHERE kind = "
      "'label' AND substr(word, 1, length(?)) = ? AND "
      "instr(lower(substr(word, length(?) + 1)), lower(?)) > 0)",
      values);
}

Result<ClipSet> ClipSelector::with_event(std::string_view name) const {
  const IndexValue values[] = {name};
  return index_->select("SELECT clip FROM event WHERE name = ?", values);
}

Result<ClipSet> ClipSelector::with_problem(std::string_view kind) const {
  const IndexValue values[] = {kind};
  return index_->select("SELECT clip FROM problem WHERE kind = ?", values);
}

Result<ClipSet> ClipSelector::with_words(std::span<const std::string> words) const {
  // Each word is a string of FTS5's language, in which '"' is doubled.
  std::string match;
  for (const std::string& word : words) {
    match += '"';
    for (const char c : word) match.append(c == '"' ? 2 : 1, c);
    match += "\" ";
  }
  const IndexValue values[] = {std::string_view(match)};
  return index_->select("SELECT rowid FROM words WHERE words MATCH ?", values);
}

Result<ClipSet> ClipSelector::with_quality(Verdict quality) const {
  const IndexValue values[] = {name(quality)};
  return index_->select("SELECT number FROM clip WHERE quality = ?", values);
}

}  // namespace marey::recordings
