// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/library_index.h"

#include <cstdint>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "core/base/input_file.h"
#include "recordings/base/sqlite.h"

namespace marey::recordings {
namespace {

namespace fs = std::filesystem;

constexpr int kIndexApplication = 0x4d4c4942;  // "MLIB"

constexpr const char* kIndexSchema = R"(
CREATE TABLE source(
  id TEXT PRIMARY KEY, path TEXT NOT NULL, kind TEXT NOT NULL, licence TEXT NOT NULL,
  origin TEXT NOT NULL, commit_id TEXT NOT NULL, subject TEXT NOT NULL,
  attribution TEXT NOT NULL
) STRICT, WITHOUT ROWID;
CREATE TABLE clip(
  number INTEGER PRIMARY KEY, id TEXT NOT NULL UNIQUE, source TEXT NOT NULL,
  name TEXT NOT NULL, body TEXT NOT NULL, first INTEGER NOT NULL, last INTEGER NOT NULL,
  rate_hz REAL NOT NULL, rate_by TEXT NOT NULL, seconds REAL NOT NULL, key TEXT NOT NULL,
  quality TEXT NOT NULL, licence TEXT NOT NULL, subject TEXT NOT NULL,
  split TEXT NOT NULL, duplicate_of TEXT NOT NULL, mirror_of TEXT NOT NULL
) STRICT;
CREATE TABLE figure(
  clip INTEGER NOT NULL, name TEXT NOT NULL, value REAL NOT NULL, verdict TEXT,
  joint TEXT NOT NULL, a INTEGER, b INTEGER, PRIMARY KEY(clip, name)
) STRICT, WITHOUT ROWID;
CREATE TABLE problem(
  clip INTEGER NOT NULL, a INTEGER NOT NULL, b INTEGER NOT NULL, kind TEXT NOT NULL,
  joint TEXT NOT NULL, value REAL NOT NULL
) STRICT;
CREATE TABLE label(
  clip INTEGER NOT NULL, a REAL NOT NULL, b REAL NOT NULL, name TEXT NOT NULL,
  by TEXT NOT NULL, certainty REAL NOT NULL
) STRICT;
CREATE TABLE event(
  clip INTEGER NOT NULL, frame INTEGER NOT NULL, name TEXT NOT NULL
) STRICT;
)";

/// Made after the rows, which is faster than keeping them up to date.
constexpr const char* kIndexIndexes = R"(
CREATE INDEX clip_source ON clip(source);
CREATE INDEX figure_name ON figure(name, value);
CREATE INDEX problem_clip ON problem(clip);
CREATE INDEX label_name ON label(name, clip);
CREATE INDEX event_name ON event(name, clip);
CREATE VIRTUAL TABLE words USING fts5(name, labels, content='');
INSERT INTO words(rowid, name, labels)
  SELECT number, name, coalesce((SELECT group_concat(name, ' ') FROM
    (SELECT DISTINCT name FROM label WHERE clip = number ORDER BY name)), '')
  FROM clip ORDER BY number;
)";

/// Fills the tables of a new database.
class IndexWriter {
 public:
  explicit IndexWriter(sqlite3* database)
      : source_(database, "INSERT OR IGNORE INTO source VALUES(?,?,?,?,?,?,?,?)"),
        clip_(database, "INSERT INTO clip VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)"),
        figure_(database, "INSERT OR REPLACE INTO figure VALUES(?,?,?,?,?,?,?)"),
        problem_(database, "INSERT INTO problem VALUES(?,?,?,?,?,?)"),
        label_(database, "INSERT INTO label VALUES(?,?,?,?,?,?)"),
        event_(database, "INSERT INTO event VALUES(?,?,?)") {}

  [[nodiscard]] bool add(std::int64_t number, const ClipRecord& record) {
    return add_source(record.provenance) && add_clip(number, record) &&
           add_figures(number, record) && add_rest(number, record);
  }

 private:
  bool add_source(const Provenance& from) {
    source_.bind(0, std::string_view(from.source_id));
    source_.bind(1, std::string_view(from.path));
    source_.bind(2, std::string_view(from.kind));
    source_.bind(3, std::string_view(from.licence));
    source_.bind(4, std::string_view(from.origin));
    source_.bind(5, std::string_view(from.commit));
    source_.bind(6, std::string_view(from.subject));
    source_.bind(7, std::string_view(from.attribution));
    return source_.run();
  }

  bool add_clip(std::int64_t number, const ClipRecord& record) {
    clip_.bind(0, number);
    clip_.bind(1, std::string_view(record.clip_id));
    clip_.bind(2, std::string_view(record.provenance.source_id));
    clip_.bind(3, std::string_view(record.name));
    clip_.bind(4, std::string_view(record.body));
    clip_.bind(5, std::int64_t{record.first_frame});
    clip_.bind(6, std::int64_t{record.last_frame});
    clip_.bind(7, record.rate_hz);
    clip_.bind(8, name(record.rate_by));
    clip_.bind(9, record.duration_s());
    clip_.bind(10, std::string_view(record.object_key));
    clip_.bind(11, name(record.quality));
    clip_.bind(12, std::string_view(record.provenance.licence));
    clip_.bind(13, std::string_view(record.provenance.subject));
    clip_.bind(14, std::string_view(record.split));
    clip_.bind(15, std::string_view(record.duplicate_of));
    clip_.bind(16, std::string_view(record.mirror_of));
    return clip_.run();
  }

  bool add_figures(std::int64_t number, const ClipRecord& record) {
    for (const ClipFigure& figure : record.figures) {
      figure_.bind(0, number);
      figure_.bind(1, std::string_view(figure.name));
      figure_.bind(2, figure.value);
      figure_.bind(3, nullptr);
      if (figure.verdict) figure_.bind(3, name(*figure.verdict));
      figure_.bind(4, std::string_view(figure.joint));
      figure_.bind(5, nullptr);
      figure_.bind(6, nullptr);
      if (figure.frames) {
        figure_.bind(5, std::int64_t{figure.frames->first});
        figure_.bind(6, std::int64_t{figure.frames->last});
      }
      if (!figure_.run()) return false;
    }
    return true;
  }

  bool add_rest(std::int64_t number, const ClipRecord& record) {
    for (const ClipProblem& problem : record.problems) {
      problem_.bind(0, number);
      problem_.bind(1, std::int64_t{problem.frames.first});
      problem_.bind(2, std::int64_t{problem.frames.last});
      problem_.bind(3, std::string_view(problem.kind));
      problem_.bind(4, std::string_view(problem.joint));
      problem_.bind(5, problem.value);
      if (!problem_.run()) return false;
    }
    for (const ClipLabel& label : record.labels) {
      label_.bind(0, number);
      label_.bind(1, label.start_s);
      label_.bind(2, label.end_s);
      label_.bind(3, std::string_view(label.text));
      label_.bind(4, std::string_view(label.by));
      label_.bind(5, label.certainty);
      if (!label_.run()) return false;
    }
    for (const ClipEvent& event : record.events) {
      event_.bind(0, number);
      event_.bind(1, std::int64_t{event.frame});
      event_.bind(2, std::string_view(event.name));
      if (!event_.run()) return false;
    }
    return true;
  }

  Statement source_;
  Statement clip_;
  Statement figure_;
  Statement problem_;
  Statement label_;
  Statement event_;
};

/// Removes a file at its end, unless it was moved to its place.
class PartialIndex {
 public:
  explicit PartialIndex(fs::path file) : file_(std::move(file)) { remove(); }
  ~PartialIndex() { remove(); }
  PartialIndex(const PartialIndex&) = delete;
  PartialIndex& operator=(const PartialIndex&) = delete;
  [[nodiscard]] const fs::path& path() const { return file_; }

 private:
  void remove() const {
    std::error_code ignored;
    fs::remove(file_, ignored);
  }
  fs::path file_;
};

bool fill(sqlite3* database, std::span<const ClipRecord> records) {
  // Without a journal: an incomplete file is never moved to its place.
  if (!execute(database,
               "PRAGMA journal_mode=OFF; PRAGMA synchronous=OFF; PRAGMA "
               "locking_mode=EXCLUSIVE; PRAGMA application_id=" +
                   std::to_string(kIndexApplication) + "; PRAGMA user_version=" +
                   std::to_string(kLibraryIndexVersion) + "; BEGIN;") ||
      !execute(database, kIndexSchema)) {
    return false;
  }
  {
    IndexWriter writer(database);
    std::int64_t number = 0;
    for (const ClipRecord& record : records) {
      if (!writer.add(number++, record)) return false;
    }
  }
  return execute(database, kIndexIndexes) && execute(database, "COMMIT");
}

/// Writes a file's content to the disk. Returns false if that failed.
bool flush(const fs::path& file) {
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool is_done = fsync(descriptor) == 0;
  close(descriptor);
  return is_done;
}

Error bad_index(const fs::path& path, std::string cause) {
  return bad_input(
      path.string(), std::move(cause), "build the library again: marey library build");
}

}  // namespace

Status write_library_index(const std::filesystem::path& path,
                           std::span<const ClipRecord> records) {
  const PartialIndex partial(path.string() + ".partial");
  Database database =
      open_database(partial.path(), SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
  const char* what = "the index of the library cannot be written";
  if (!database) {
    return Error{Errc::kDevice, path.string(), what, "check the folder and its disk"};
  }
  if (!fill(database.get(), records)) {
    return disk_error(path.string(), database.get(), what);
  }
  database.reset();
  std::error_code problem;
  const bool is_flushed = flush(partial.path());
  if (is_flushed) fs::rename(partial.path(), path, problem);
  if (is_flushed && !problem) return Done{};
  return Error{Errc::kDevice, path.string(), what, "free some disk space"};
}

Result<std::vector<int>> find_in_index(const std::filesystem::path& path,
                                       const IndexCondition& condition) {
  if (const Status ok = check_input_file(path); !ok) return ok.error();
  const Database database = open_database(path, SQLITE_OPEN_READONLY, "immutable=1");
  if (!database) return bad_index(path, "it cannot be opened");
  if (setting_of(database.get(), "application_id") != kIndexApplication) {
    return bad_index(path, "it is no index of a library, or it is damaged");
  }
  if (setting_of(database.get(), "user_version") != kLibraryIndexVersion) {
    return bad_index(path, "another version of marey made it");
  }
  std::string text = "SELECT number FROM clip";
  if (!condition.sql.empty()) text += " WHERE " + condition.sql;
  text += " ORDER BY number";
  Statement query(database.get(), text);
  for (std::size_t i = 0; i < condition.values.size(); ++i) {
    query.bind(static_cast<int>(i), std::string_view(condition.values[i]));
  }
  std::vector<int> out;
  while (query.next_row()) out.push_back(static_cast<int>(query.integer(0)));
  if (query.failed()) {
    return bad_index(path,
                     std::string("it is damaged: ") + sqlite3_errmsg(database.get()));
  }
  return out;
}

}  // namespace marey::recordings
