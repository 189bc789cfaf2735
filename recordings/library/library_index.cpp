// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/library_index.h"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "recordings/base/sqlite.h"
#include "recordings/library/open_index.h"

namespace marey::recordings {
namespace {

namespace fs = std::filesystem;

constexpr const char* kIndexSchema = R"(
CREATE TABLE head(
  version INTEGER NOT NULL, version_name TEXT NOT NULL, search TEXT NOT NULL,
  inputs TEXT NOT NULL, clips INTEGER NOT NULL, warned INTEGER NOT NULL,
  failed INTEGER NOT NULL, duplicates INTEGER NOT NULL, seconds REAL NOT NULL,
  remarks TEXT NOT NULL, settings TEXT NOT NULL
) STRICT;
CREATE TABLE source(
  id INTEGER PRIMARY KEY, sha256 TEXT NOT NULL, path TEXT NOT NULL, kind TEXT NOT NULL,
  licence TEXT NOT NULL, origin TEXT NOT NULL, commit_id TEXT NOT NULL,
  subject TEXT NOT NULL, attribution TEXT NOT NULL
) STRICT;
CREATE TABLE clip(
  number INTEGER PRIMARY KEY, id TEXT NOT NULL, source INTEGER NOT NULL,
  name TEXT NOT NULL, body TEXT NOT NULL, first INTEGER NOT NULL, last INTEGER NOT NULL,
  rate_hz REAL NOT NULL, rate_by TEXT NOT NULL, seconds REAL NOT NULL, key TEXT NOT NULL,
  quality TEXT NOT NULL, licence TEXT NOT NULL, subject TEXT NOT NULL,
  split TEXT NOT NULL, duplicate_of TEXT NOT NULL, mirror_of TEXT NOT NULL
) STRICT;
CREATE TABLE figure(
  clip INTEGER NOT NULL, place INTEGER NOT NULL, name TEXT NOT NULL, value REAL NOT NULL,
  verdict TEXT, joint TEXT NOT NULL, a INTEGER, b INTEGER, PRIMARY KEY(clip, place)
) STRICT, WITHOUT ROWID;
CREATE TABLE problem(
  clip INTEGER NOT NULL, place INTEGER NOT NULL, a INTEGER NOT NULL, b INTEGER NOT NULL,
  kind TEXT NOT NULL, joint TEXT NOT NULL, value REAL NOT NULL, PRIMARY KEY(clip, place)
) STRICT, WITHOUT ROWID;
CREATE TABLE label(
  clip INTEGER NOT NULL, place INTEGER NOT NULL, a REAL NOT NULL, b REAL NOT NULL,
  name TEXT NOT NULL, by TEXT NOT NULL, certainty REAL NOT NULL, PRIMARY KEY(clip, place)
) STRICT, WITHOUT ROWID;
CREATE TABLE event(
  clip INTEGER NOT NULL, place INTEGER NOT NULL, frame INTEGER NOT NULL,
  name TEXT NOT NULL, PRIMARY KEY(clip, place)
) STRICT, WITHOUT ROWID;
CREATE TABLE vocabulary(
  kind TEXT NOT NULL, word TEXT NOT NULL, clips INTEGER NOT NULL, PRIMARY KEY(kind, word)
) STRICT, WITHOUT ROWID;
CREATE VIRTUAL TABLE words USING fts5(name, labels, content='');
)";

/// Made after the rows, which is faster than keeping them up to date. The columns that
/// conditions need are in them, so that no other pages are read.
constexpr const char* kIndexIndexes = R"(
CREATE UNIQUE INDEX clip_id ON clip(id);
CREATE INDEX clip_name ON clip(name);
CREATE INDEX clip_facts ON clip(quality, split, licence, subject, seconds, rate_hz);
CREATE INDEX figure_name ON figure(name, value);
CREATE INDEX problem_kind ON problem(kind);
CREATE INDEX label_name ON label(name, clip, a, b);
CREATE INDEX event_name ON event(name);
)";

/// Number of clips with a word, and the last of them.
struct WordCount {
  std::int64_t clips = 0;
  std::int64_t last_clip = -1;
};

/// Fills the tables of a new database.
class IndexWriter {
 public:
  explicit IndexWriter(sqlite3* database)
      : source_(database, "INSERT INTO source VALUES(?,?,?,?,?,?,?,?,?)"),
        clip_(database, "INSERT INTO clip VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)"),
        figure_(database, "INSERT INTO figure VALUES(?,?,?,?,?,?,?,?)"),
        problem_(database, "INSERT INTO problem VALUES(?,?,?,?,?,?,?)"),
        label_(database, "INSERT INTO label VALUES(?,?,?,?,?,?,?)"),
        event_(database, "INSERT INTO event VALUES(?,?,?,?)"),
        vocabulary_(database, "INSERT INTO vocabulary VALUES(?,?,?)"),
        words_(database, "INSERT INTO words(rowid, name, labels) VALUES(?,?,?)") {}

  [[nodiscard]] bool add(std::int64_t number, const ClipRecord& record) {
    number_ = number;
    return add_clip(record) && add_figures(record) && add_problems(record) &&
           add_labels(record) && add_events(record) && add_words(record);
  }

  /// Writes what was collected over all clips.
  [[nodiscard]] bool finish() {
    for (const auto& [word, count] : counts_) {
      vocabulary_.bind(0, std::string_view(word.first));
      vocabulary_.bind(1, std::string_view(word.second));
      vocabulary_.bind(2, count.clips);
      if (!vocabulary_.run()) return false;
    }
    return true;
  }

 private:
  /// Returns the number of a source, which is written when it is new.
  std::optional<std::int64_t> source_number(const Provenance& from) {
    const std::array texts = {&from.source_id,
                              &from.path,
                              &from.kind,
                              &from.licence,
                              &from.origin,
                              &from.commit,
                              &from.subject,
                              &from.attribution};
    std::string key;
    for (const std::string* text : texts)
      key += std::to_string(text->size()) + ':' + *text;
    const auto next = static_cast<std::int64_t>(sources_.size());
    const auto [place, is_new] = sources_.try_emplace(std::move(key), next);
    if (!is_new) return place->second;
    source_.bind(0, next);
    for (std::size_t k = 0; k < texts.size(); ++k) {
      source_.bind(static_cast<int>(k) + 1, std::string_view(*texts[k]));
    }
    if (!source_.run()) return std::nullopt;
    return next;
  }

  bool add_clip(const ClipRecord& record) {
    const auto source = source_number(record.provenance);
    if (!source) return false;
    clip_.bind(0, number_);
    clip_.bind(1, std::string_view(record.clip_id));
    clip_.bind(2, *source);
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
    count("kind", record.provenance.kind);
    count("licence", record.provenance.licence);
    count("subject", record.provenance.subject);
    count("split", record.split);
    return clip_.run();
  }

  bool add_figures(const ClipRecord& record) {
    std::int64_t place = 0;
    for (const ClipFigure& figure : record.figures) {
      figure_.bind(0, number_);
      figure_.bind(1, place++);
      figure_.bind(2, std::string_view(figure.name));
      figure_.bind(3, figure.value);
      figure_.bind(4, nullptr);
      if (figure.verdict) figure_.bind(4, name(*figure.verdict));
      figure_.bind(5, std::string_view(figure.joint));
      figure_.bind(6, nullptr);
      figure_.bind(7, nullptr);
      if (figure.frames) {
        figure_.bind(6, std::int64_t{figure.frames->first});
        figure_.bind(7, std::int64_t{figure.frames->last});
      }
      count("figure", figure.name);
      if (!figure_.run()) return false;
    }
    return true;
  }

  bool add_problems(const ClipRecord& record) {
    std::int64_t place = 0;
    for (const ClipProblem& problem : record.problems) {
      problem_.bind(0, number_);
      problem_.bind(1, place++);
      problem_.bind(2, std::int64_t{problem.frames.first});
      problem_.bind(3, std::int64_t{problem.frames.last});
      problem_.bind(4, std::string_view(problem.kind));
      problem_.bind(5, std::string_view(problem.joint));
      problem_.bind(6, problem.value);
      count("problem", problem.kind);
      if (!problem_.run()) return false;
    }
    return true;
  }

  bool add_labels(const ClipRecord& record) {
    std::int64_t place = 0;
    for (const ClipLabel& label : record.labels) {
      label_.bind(0, number_);
      label_.bind(1, place++);
      label_.bind(2, label.start_s);
      label_.bind(3, label.end_s);
      label_.bind(4, std::string_view(label.text));
      label_.bind(5, std::string_view(label.by));
      label_.bind(6, label.certainty);
      count("label", label.text);
      if (!label_.run()) return false;
    }
    return true;
  }

  bool add_events(const ClipRecord& record) {
    std::int64_t place = 0;
    for (const ClipEvent& event : record.events) {
      event_.bind(0, number_);
      event_.bind(1, place++);
      event_.bind(2, std::int64_t{event.frame});
      event_.bind(3, std::string_view(event.name));
      count("event", event.name);
      if (!event_.run()) return false;
    }
    return true;
  }

  /// Labels by marey are left out: they would be found in nearly every clip.
  bool add_words(const ClipRecord& record) {
    std::set<std::string_view> texts;
    for (const ClipLabel& label : record.labels) {
      if (label.by != "marey") texts.insert(label.text);
    }
    std::string joined;
    for (const std::string_view text : texts) joined.append(text).append(1, ' ');
    words_.bind(0, number_);
    words_.bind(1, std::string_view(record.name));
    words_.bind(2, std::string_view(joined));
    return words_.run();
  }

  void count(std::string_view kind, const std::string& word) {
    if (word.empty()) return;
    WordCount& count = counts_[{kind, word}];
    if (std::exchange(count.last_clip, number_) != number_) ++count.clips;
  }

  std::int64_t number_ = 0;
  std::map<std::string, std::int64_t> sources_;
  std::map<std::pair<std::string_view, std::string>, WordCount> counts_;
  Statement source_;
  Statement clip_;
  Statement figure_;
  Statement problem_;
  Statement label_;
  Statement event_;
  Statement vocabulary_;
  Statement words_;
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

bool add_head(sqlite3* database, const IndexHead& head) {
  Statement row(database, "INSERT INTO head VALUES(?,?,?,?,?,?,?,?,?,?,?)");
  row.bind(0, std::int64_t{head.version});
  row.bind(1, std::string_view(head.version_name));
  row.bind(2, std::string_view(head.search));
  row.bind(3, std::string_view(head.inputs));
  row.bind(4, head.clips);
  row.bind(5, head.warned);
  row.bind(6, head.failed);
  row.bind(7, head.duplicates);
  row.bind(8, head.seconds);
  row.bind(9, std::string_view(head.remarks));
  row.bind(10, std::string_view(head.settings));
  return row.run();
}

bool fill(sqlite3* database, std::span<const ClipRecord> records, const IndexHead& head) {
  // Without a journal: an incomplete file is never moved to its place.
  if (!execute(database,
               "PRAGMA journal_mode=OFF; PRAGMA synchronous=OFF; PRAGMA "
               "locking_mode=EXCLUSIVE; PRAGMA application_id=" +
                   std::to_string(kIndexApplication) + "; PRAGMA user_version=" +
                   std::to_string(kLibraryIndexVersion) + "; BEGIN;") ||
      !execute(database, kIndexSchema) || !add_head(database, head)) {
    return false;
  }
  {
    IndexWriter writer(database);
    std::int64_t number = 0;
    for (const ClipRecord& record : records) {
      if (!writer.add(number++, record)) return false;
    }
    if (!writer.finish()) return false;
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

}  // namespace

Status write_library_index(const std::filesystem::path& path,
                           std::span<const ClipRecord> records,
                           const IndexHead& head) {
  const PartialIndex partial(path.string() + ".partial");
  Database database =
      open_database(partial.path(), SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
  const char* what = "the index of the library cannot be written";
  if (!database) {
    return Error{Errc::kDevice, path.string(), what, "check the folder and its disk"};
  }
  if (!fill(database.get(), records, head)) {
    return disk_error(path.string(), database.get(), what);
  }
  database.reset();
  std::error_code problem;
  const bool is_flushed = flush(partial.path());
  if (is_flushed) fs::rename(partial.path(), path, problem);
  if (is_flushed && !problem) return Done{};
  return Error{Errc::kDevice, path.string(), what, "free some disk space"};
}

}  // namespace marey::recordings
