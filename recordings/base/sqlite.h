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

#include "core/base/result.h"

// Private to recordings/: the required subset of SQLite, with RAII.
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

/// Runs statements without results. Returns false if one failed: see sqlite3_errmsg().
[[nodiscard]] bool execute(sqlite3* database, const std::string& statements);

/// Returns the number of a pragma; -1 if the file is no database.
[[nodiscard]] std::int64_t setting_of(sqlite3* database, const std::string& name);

/// Identification of a kind of database of recordings.
struct RecordedKind {
  int application = 0;           ///< SQLite's application_id.
  int version = 0;               ///< SQLite's user_version.
  const char* schema = nullptr;  ///< The statements that create its tables.
};

/// Begins a recording: creates the file, with a write-ahead log, its tables and the rows
/// that `write_head` inserts. Errors: (kDevice) a disk error, and no file is left;
/// (kBadInput) the file already exists; `instead` is the next step.
[[nodiscard]] Result<Database> begin_recorded(
    const std::filesystem::path& file,
    const RecordedKind& kind,
    const std::string& instead,
    const std::function<bool(sqlite3*)>& write_head);

/// Opens a recording for reading; the result holds null if it is no database. Never
/// writes in or next to it: if a killed process left its log, file and log are merged in
/// a copy in the folder for temporary files, which is deleted once it is open. Views and
/// triggers are disabled, and no value is larger than the file. Errors: those of
/// check_input_file(); the copy cannot be created (kDevice).
[[nodiscard]] Result<Database> open_recorded(const std::filesystem::path& file);

/// Opens the bytes of a database for reading, without a copy; null when they are none.
/// Limited as open_recorded(). `bytes` must outlive the result.
[[nodiscard]] Database open_bytes(std::span<const std::byte> bytes);

/// Returns the bytes of a database that is open for writing; empty: no memory is left.
[[nodiscard]] std::string bytes_of_database(sqlite3* database);

/// Returns true if the tables are exactly those of `schema`. A table with computed rows
/// or columns could be infinite.
[[nodiscard]] bool has_schema(sqlite3* database, std::string_view schema);

/// Returns an upper bound of the number of rows of a table in this file, because its
/// pages may reference each other in a cycle.
[[nodiscard]] std::int64_t max_rows(const std::filesystem::path& file);

/// Returns SQLite's error of a failed write (kDevice).
[[nodiscard]] Error disk_error(const std::string& file,
                               sqlite3* database,
                               const std::string& what);

/// A prepared statement. Parameters and columns count from 0.
class Statement {
 public:
  Statement(sqlite3* database, std::string_view text);

  void bind(int place, std::int64_t value);
  void bind(int place, double value);
  void bind(int place, std::string_view value);
  void bind(int place, std::span<const std::byte> value);
  void bind(int place, std::nullptr_t);
  /// Runs a statement without results, and resets it for the next values.
  [[nodiscard]] bool run();
  /// Fetches the next row, if any. After the last one, failed() distinguishes the end
  /// from an error.
  [[nodiscard]] bool next_row();
  /// Ends the rows of a query, so that other values can be bound.
  void reset();
  [[nodiscard]] bool failed() const { return result_ != SQLITE_DONE; }

  [[nodiscard]] bool is_null(int column) const;
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
