// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/sqlite.h"

namespace marey::recordings {

Database open_database(const std::string& name, int flags) {
  sqlite3* raw = nullptr;
  const int result = sqlite3_open_v2(name.c_str(), &raw, flags, nullptr);
  Database database(raw);
  if (result != SQLITE_OK) return nullptr;
  sqlite3_busy_timeout(raw, 2000);
  return database;
}

bool execute(sqlite3* database, const std::string& statements) {
  return sqlite3_exec(database, statements.c_str(), nullptr, nullptr, nullptr) ==
         SQLITE_OK;
}

Statement::Statement(sqlite3* database, std::string_view text) {
  sqlite3_stmt* raw = nullptr;
  result_ = sqlite3_prepare_v2(
      database, text.data(), static_cast<int>(text.size()), &raw, nullptr);
  statement_.reset(raw);
}

void Statement::bind(int place, std::int64_t value) {
  sqlite3_bind_int64(statement_.get(), place + 1, value);
}

void Statement::bind(int place, double value) {
  sqlite3_bind_double(statement_.get(), place + 1, value);
}

void Statement::bind(int place, std::string_view value) {
  sqlite3_bind_text(statement_.get(),
                    place + 1,
                    value.data(),
                    static_cast<int>(value.size()),
                    SQLITE_TRANSIENT);
}

bool Statement::run() {
  if (!statement_) return false;
  result_ = sqlite3_step(statement_.get());
  sqlite3_reset(statement_.get());
  return result_ == SQLITE_DONE;
}

bool Statement::next_row() {
  if (!statement_) return false;
  result_ = sqlite3_step(statement_.get());
  return result_ == SQLITE_ROW;
}

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

double Statement::number(int column) const {
  return sqlite3_column_double(statement_.get(), column);
}

std::string Statement::text(int column) const {
  const auto* bytes = sqlite3_column_text(statement_.get(), column);
  const int size = sqlite3_column_bytes(statement_.get(), column);
  if (bytes == nullptr || size <= 0) return {};
  return {reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size)};
}

}  // namespace marey::recordings
