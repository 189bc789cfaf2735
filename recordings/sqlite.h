// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include <sqlite3.h>

#include "core/result.h"

// Private to recordings/: what of SQLite is needed, without its pairs of calls.
namespace marey::recordings {

struct CloseDatabase {
  void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
};
using Database = std::unique_ptr<sqlite3, CloseDatabase>;

/// Opens a database; null when it cannot be opened. `flags` as sqlite3_open_v2();
/// `query` as in SQLite's URIs: "immutable=1".
[[nodiscard]] Database open_database(const std::filesystem::path& file,
                                     int flags,
                                     const std::string& query = {});

/// Runs statements without results. False when one failed: see sqlite3_errmsg().
[[nodiscard]] bool execute(sqlite3* database, const std::string& statements);

/// A pragma's number; -1 where the file is no database.
[[nodiscard]] std::int64_t setting_of(sqlite3* database, const std::string& name);

/// What a database of recordings is told by.
struct RecordedKind {
  int application = 0;           ///< SQLite's application_id.
  int version = 0;               ///< SQLite's user_version.
  const char* schema = nullptr;  ///< The statements that make its tables.
};

/// Begins a recording: makes the file, with a write-ahead log, its tables and what
/// `write_head` puts there. Errors (kDevice): the disk, and no file is left; (kBadInput):
/// the file is there already, and `instead` says what to do.
[[nodiscard]] Result<Database> begin_recorded(
    const std::filesystem::path& file,
    const RecordedKind& kind,
    const std::string& instead,
    const std::function<bool(sqlite3*)>& write_head);

/// Opens a recording to be read; null inside when it is no database. Nothing beside or in
/// it is written: where a process was killed and left its log behind, both are put
/// together in a copy in the folder for temporary files, which is gone once it is open.
/// Views and triggers do not work in it, and no value is larger than the file.
/// Errors: check_input_file()'s; the copy cannot be made (kDevice).
[[nodiscard]] Result<Database> open_recorded(const std::filesystem::path& file);

/// Returns true if the tables are those of `schema` and nothing else: a table that
/// computes its rows or columns has no end.
[[nodiscard]] bool has_schema(sqlite3* database, std::string_view schema);

/// Returns a number of rows that a table of this file cannot exceed: its pages may refer
/// to each other in a circle.
[[nodiscard]] std::int64_t max_rows(const std::filesystem::path& file);

/// What SQLite says of a write that failed (kDevice).
[[nodiscard]] Error disk_error(const std::string& file,
                               sqlite3* database,
                               const std::string& what);

/// A prepared statement. Binding and columns count from 0.
class Statement {
 public:
  Statement(sqlite3* database, std::string_view text);

  void bind(int place, std::int64_t value);
  void bind(int place, double value);
  void bind(int place, std::string_view value);
  void bind(int place, std::span<const std::byte> value);
  /// Runs a statement without results, and makes it ready for the next values.
  [[nodiscard]] bool run();
  /// The next row, if any. After the last, failed() tells an end from an error.
  [[nodiscard]] bool next_row();
  [[nodiscard]] bool failed() const { return result_ != SQLITE_DONE; }

  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] double number(int column) const;
  [[nodiscard]] std::string text(int column) const;
  /// Valid until the next row.
  [[nodiscard]] std::span<const std::byte> bytes(int column) const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
  };
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  int result_ = SQLITE_ERROR;
};

}  // namespace marey::recordings
