// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/library_records.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "core/base/assert.h"
#include "core/base/hex_digits.h"
#include "recordings/base/sqlite.h"
#include "recordings/library/enum_named.h"
#include "recordings/library/open_index.h"

namespace marey::recordings {
namespace {

namespace fs = std::filesystem;

/// Checks an id. An export's index also has the ids of mirrored copies.
bool is_clip_id(std::string_view id) {
  constexpr std::string_view kMirror = "_mirror";
  if (id.ends_with(kMirror)) id.remove_suffix(kMirror.size());
  return is_hex(id, 16);
}

/// An open index, read clip by clip. Stores the first defect; results after it are
/// meaningless.
class ClipReader {
 public:
  ClipReader(const fs::path& path, sqlite3* database)
      : path_(path),
        database_(database),
        max_rows_(max_rows(path)),
        clip_(database,
              "SELECT id, source, name, body, first, last, rate_hz, rate_by, key, "
              "quality, split, duplicate_of, mirror_of FROM clip WHERE number = ?"),
        source_(database,
                "SELECT sha256, path, kind, licence, origin, commit_id, subject, "
                "attribution FROM source WHERE id = ?"),
        figure_(database,
                "SELECT name, value, verdict, joint, a, b FROM figure WHERE clip = ? "
                "ORDER BY place"),
        problem_(database,
                 "SELECT a, b, kind, joint, value FROM problem WHERE clip = ? "
                 "ORDER BY place"),
        label_(database,
               "SELECT a, b, name, by, certainty FROM label WHERE clip = ? "
               "ORDER BY place"),
        event_(database, "SELECT frame, name FROM event WHERE clip = ? ORDER BY place"),
        summary_(database,
                 "SELECT id, name, seconds, rate_hz, quality, licence, subject, split "
                 "FROM clip WHERE number = ?"),
        texts_(database, "SELECT name, by = 'marey' FROM label WHERE clip = ?") {}

  ClipRecord record(int number) {
    rows_left_ = max_rows_;
    ClipRecord out;
    std::int64_t source = -1;
    one_row(clip_, number, [&] {
      out.clip_id = id(clip_, 0);
      source = clip_.integer(1);
      out.name = clip_.text(2);
      out.body = clip_.text(3);
      out.first_frame = whole(clip_, 4);
      out.last_frame = whole(clip_, 5);
      const std::int64_t more = std::int64_t{out.last_frame} - out.first_frame;
      if (more < 0 || more >= std::numeric_limits<int>::max()) {
        fail("it is damaged: the frames of a clip are wrong");
      }
      out.rate_hz = clip_.number(6);
      out.rate_by = word<RateBasis>(clip_, 7);
      out.object_key = clip_.text(8);
      if (!is_hex(out.object_key, 64)) fail("it is damaged: a key of an object is wrong");
      out.quality = word<Verdict>(clip_, 9);
      out.split = clip_.text(10);
      if (!clip_.text(11).empty()) out.duplicate_of = id(clip_, 11);
      if (!clip_.text(12).empty()) out.mirror_of = id(clip_, 12);
    });
    out.provenance = provenance(source);
    read_lists(number, out);
    return out;
  }

  ClipSummary summary(int number) {
    rows_left_ = max_rows_;
    ClipSummary out;
    out.number = number;
    one_row(summary_, number, [&] {
      out.clip_id = id(summary_, 0);
      out.name = summary_.text(1);
      out.duration_s = summary_.number(2);
      out.rate_hz = summary_.number(3);
      out.quality = word<Verdict>(summary_, 4);
      out.licence = summary_.text(5);
      out.subject = summary_.text(6);
      out.split = summary_.text(7);
    });
    std::set<std::string> labels;
    std::set<std::string> found;
    each_row(texts_, number, [&] {
      (texts_.integer(1) != 0 ? found : labels).insert(texts_.text(0));
    });
    out.labels.assign(labels.begin(), labels.end());
    out.found_labels.assign(found.begin(), found.end());
    return out;
  }

  [[nodiscard]] const std::optional<Error>& defect() const { return defect_; }

 private:
  void read_lists(int number, ClipRecord& out) {
    each_row(figure_, number, [&] {
      ClipFigure& figure = out.figures.emplace_back();
      figure.name = figure_.text(0);
      figure.value = figure_.number(1);
      if (!figure_.is_null(2)) figure.verdict = word<Verdict>(figure_, 2);
      figure.joint = figure_.text(3);
      if (!figure_.is_null(4)) {
        figure.frames = FrameRange{whole(figure_, 4), whole(figure_, 5)};
      }
    });
    each_row(problem_, number, [&] {
      out.problems.push_back({{whole(problem_, 0), whole(problem_, 1)},
                              problem_.text(2),
                              problem_.text(3),
                              problem_.number(4)});
    });
    each_row(label_, number, [&] {
      out.labels.push_back({label_.number(0),
                            label_.number(1),
                            label_.text(2),
                            label_.text(3),
                            label_.number(4)});
    });
    each_row(event_, number, [&] {
      out.events.push_back({whole(event_, 0), event_.text(1)});
    });
  }

  /// Clips of one source follow each other: the last one is kept.
  const Provenance& provenance(std::int64_t id) {
    if (id == last_source_ || defect_) return last_provenance_;
    last_source_ = id;
    one_row(source_, id, [&] {
      last_provenance_ = {source_.text(0),
                          source_.text(1),
                          source_.text(2),
                          source_.text(3),
                          source_.text(4),
                          source_.text(5),
                          source_.text(6),
                          source_.text(7)};
    });
    return last_provenance_;
  }

  void one_row(Statement& query, std::int64_t key, const std::function<void()>& read) {
    int rows = 0;
    each_row(query, key, [&] {
      if (++rows == 1) read();
    });
    if (rows != 1) fail("it is damaged: a row is missing");
  }

  void each_row(Statement& query, std::int64_t key, const std::function<void()>& read) {
    if (defect_) return;
    query.bind(0, key);
    while (query.next_row()) {
      // Pages of a damaged file may refer to each other in a circle.
      if (--rows_left_ < 0) return fail("it is damaged: its rows never end");
      read();
      if (defect_) return;
    }
    if (query.failed()) {
      return fail(std::string("it is damaged: ") + sqlite3_errmsg(database_));
    }
    query.reset();
  }

  int whole(const Statement& row, int column) {
    const std::int64_t value = row.integer(column);
    if (std::in_range<int>(value)) return static_cast<int>(value);
    fail("it is damaged: a number of a frame is wrong");
    return 0;
  }

  /// Ids become names of files.
  std::string id(const Statement& row, int column) {
    std::string out = row.text(column);
    if (!is_clip_id(out)) fail("it is damaged: an id of a clip is wrong");
    return out;
  }

  template <class Enum>
  Enum word(const Statement& row, int column) {
    const auto found = enum_named<Enum>(row.text(column));
    if (!found) fail("it is damaged: a word is wrong");
    return found.value_or(Enum{});
  }

  void fail(std::string cause) {
    if (!defect_) defect_ = bad_index(path_, std::move(cause));
  }

  const fs::path& path_;
  sqlite3* database_;
  std::int64_t max_rows_ = 0;
  std::int64_t rows_left_ = 0;
  std::optional<Error> defect_;
  std::int64_t last_source_ = std::numeric_limits<std::int64_t>::min();
  Provenance last_provenance_;
  Statement clip_;
  Statement source_;
  Statement figure_;
  Statement problem_;
  Statement label_;
  Statement event_;
  Statement summary_;
  Statement texts_;
};

/// Reads one item per number.
template <class Item>
Result<std::vector<Item>> read_clips(const fs::path& index,
                                     sqlite3* database,
                                     std::span<const int> numbers,
                                     Item (ClipReader::*read)(int)) {
  const auto clips = count_clips(index, database);
  if (!clips) return clips.error();
  ClipReader reader(index, database);
  std::vector<Item> out;
  out.reserve(numbers.size());
  for (const int number : numbers) {
    if (number < 0 || number >= *clips) {
      return bad_index(index, "it has no clip with the number " + std::to_string(number));
    }
    out.push_back((reader.*read)(number));
    if (reader.defect()) return *reader.defect();
  }
  return out;
}

/// Returns the numbers from `first` on that exist, at most `count` of them.
std::vector<int> numbers_from(int first, int count, int clips) {
  std::vector<int> out(
      static_cast<std::size_t>(std::max(0, std::min(count, clips - first))));
  std::iota(out.begin(), out.end(), first);
  return out;
}

/// Opens an index, and reads the clips from `first` on.
template <class Item>
Result<std::vector<Item>> read_clips_from(const fs::path& index,
                                          int first,
                                          int count,
                                          Item (ClipReader::*read)(int)) {
  const auto database = open_index(index);
  if (!database) return database.error();
  const auto clips = count_clips(index, database->get());
  if (!clips) return clips.error();
  return read_clips(index, database->get(), numbers_from(first, count, *clips), read);
}

}  // namespace

Result<int> count_library_clips(const fs::path& index) {
  const auto database = open_index(index);
  if (!database) return database.error();
  return count_clips(index, database->get());
}

Result<std::vector<ClipRecord>> read_library_records(const fs::path& index,
                                                     std::span<const int> numbers) {
  const auto database = open_index(index);
  if (!database) return database.error();
  return read_clips(index, database->get(), numbers, &ClipReader::record);
}

Result<std::vector<ClipRecord>> read_library_records(const fs::path& index) {
  return read_clips_from(index, 0, std::numeric_limits<int>::max(), &ClipReader::record);
}

Result<std::vector<ClipSummary>> read_clip_summaries(const fs::path& index,
                                                     std::span<const int> numbers) {
  const auto database = open_index(index);
  if (!database) return database.error();
  return read_clips(index, database->get(), numbers, &ClipReader::summary);
}

Result<std::vector<ClipSummary>> read_clip_summaries(const fs::path& index,
                                                     int first,
                                                     int count) {
  MAREY_ASSERT(first >= 0 && count >= 0);
  return read_clips_from(index, first, count, &ClipReader::summary);
}

}  // namespace marey::recordings
