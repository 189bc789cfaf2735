// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include <sqlite3.h>

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

/// A prepared statement. Binding and columns count from 0.
class Statement {
 public:
  Statement(sqlite3* database, std::string_view text);

  void bind(int place, std::int64_t value);
  void bind(int place, double value);
  void bind(int place, std::string_view value);
  /// Runs a statement without results, and makes it ready for the next values.
  [[nodiscard]] bool run();
  /// The next row, if any. After the last, failed() tells an end from an error.
  [[nodiscard]] bool next_row();
  [[nodiscard]] bool failed() const { return result_ != SQLITE_DONE; }

  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] double number(int column) const;
  [[nodiscard]] std::string text(int column) const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
  };
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  int result_ = SQLITE_ERROR;
};

}  // namespace marey::recordings
