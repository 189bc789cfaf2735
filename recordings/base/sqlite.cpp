// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/base/sqlite.h"

#include <algorithm>
#include <system_error>

#include "core/base/input_file.h"
#include "recordings/base/temporary_folder.h"

namespace marey::recordings {
namespace {

namespace fs = std::filesystem;

/// Returns the file as a URI. "#", "?" and "%" are escaped, because Debian's SQLite
/// interprets every name that looks like a URI.
std::string uri_of(const std::filesystem::path& file) {
  constexpr std::string_view kHex = "0123456789ABCDEF";
  constexpr std::string_view kPlain = "/._-~";
  std::error_code ignored;
  std::string uri = "file://";
  for (const char letter : std::filesystem::absolute(file, ignored).string()) {
    const auto byte = static_cast<unsigned char>(letter);
    const bool is_plain = (byte >= '0' && byte <= '9') || (byte >= 'A' && byte <= 'Z') ||
                          (byte >= 'a' && byte <= 'z') ||
                          kPlain.find(letter) != std::string_view::npos;
    if (is_plain) {
      uri += letter;
    } else {
      uri.append({'%', kHex[byte / 16U], kHex[byte % 16U]});
    }
  }
  return uri;
}

std::string without_blanks(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c != ' ' && c != '\n' && c != '\t' && c != '\r') out += c;
  }
  return out;
}

/// Returns the size of a database and its log.
std::uintmax_t bytes_of(const std::filesystem::path& file) {
  std::uintmax_t bytes = 0;
  for (const char* suffix : {"", "-wal"}) {
    std::error_code problem;
    const auto size = std::filesystem::file_size(file.string() + suffix, problem);
    if (!problem) bytes += size;
  }
  return bytes;
}

/// Restricts an untrusted database: no views or triggers, and no value larger than the
/// file.
void limit_to(std::uintmax_t bytes, sqlite3* database) {
  constexpr std::uintmax_t kMax = 1'000'000'000;
  constexpr std::uintmax_t kMin = 1'000'000;
  sqlite3_limit(
      database, SQLITE_LIMIT_LENGTH, static_cast<int>(std::clamp(bytes, kMin, kMax)));
  for (const int setting : {SQLITE_DBCONFIG_ENABLE_VIEW,
                            SQLITE_DBCONFIG_ENABLE_TRIGGER,
                            SQLITE_DBCONFIG_TRUSTED_SCHEMA}) {
    sqlite3_db_config(database, setting, 0, nullptr);
  }
}

/// Copies a database and its log during possible writes: the file itself changes only
/// when the log is merged into it; then both are copied again.
bool copy_with_log(const fs::path& file, const fs::path& log, const fs::path& copy) {
  constexpr int kTries = 5;
  const auto options = fs::copy_options::overwrite_existing;
  std::error_code problem;
  for (int i = 0; i < kTries; ++i) {
    const auto before = fs::last_write_time(file, problem);
    if (problem) return false;
    if (!fs::copy_file(file, copy, options, problem)) return false;
    if (!fs::copy_file(log, copy.string() + "-wal", options, problem)) return false;
    if (fs::last_write_time(file, problem) == before && !problem) return true;
  }
  return false;
}

}  // namespace

Database open_database(const std::filesystem::path& file,
                       int flags,
                       const std::string& query) {
  std::string uri = uri_of(file);
  if (!query.empty()) uri += "?" + query;
  sqlite3* raw = nullptr;
  const int result = sqlite3_open_v2(uri.c_str(), &raw, flags | SQLITE_OPEN_URI, nullptr);
  Database database(raw);
  if (result != SQLITE_OK) return nullptr;
  sqlite3_busy_timeout(raw, 2000);
  return database;
}

bool execute(sqlite3* database, const std::string& statements) {
  return sqlite3_exec(database, statements.c_str(), nullptr, nullptr, nullptr) ==
         SQLITE_OK;
}

std::int64_t setting_of(sqlite3* database, const std::string& name) {
  Statement query(database, "PRAGMA " + name);
  return query.next_row() ? query.integer(0) : -1;
}

Error disk_error(const std::string& file, sqlite3* database, const std::string& what) {
  return {Errc::kDevice,
          file,
          what + ": " + sqlite3_errmsg(database),
          "free some disk space, or record to another disk"};
}

Result<Database> begin_recorded(const std::filesystem::path& file,
                                const RecordedKind& kind,
                                const std::string& instead,
                                const std::function<bool(sqlite3*)>& write_head) {
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored)) {
    return bad_input(file.string(), "a recording already exists", instead);
  }
  Database database = open_database(file, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
  if (!database) {
    return Error{Errc::kDevice,
                 file.string(),
                 "the file cannot be created",
                 "choose a folder that may be written to"};
  }
  sqlite3* const raw = database.get();
  // NORMAL does not wait for the disk at each commit: data are lost only by a power
  // failure, never by the end of the process.
  const bool made =
      execute(raw, "PRAGMA journal_mode=WAL; PRAGMA synchronous=NORMAL; BEGIN;") &&
      execute(raw,
              "PRAGMA application_id=" + std::to_string(kind.application) +
                  "; PRAGMA user_version=" + std::to_string(kind.version)) &&
      execute(raw, kind.schema) && write_head(raw) && execute(raw, "COMMIT");
  if (made) return database;
  Error error = disk_error(file.string(), raw, "the take cannot be started");
  database.reset();
  for (const char* suffix : {"", "-wal", "-shm", "-journal"}) {
    std::filesystem::remove(file.string() + suffix, ignored);
  }
  return error;
}

Result<Database> open_recorded(const fs::path& file) {
  if (const Status ok = check_input_file(file); !ok) return ok.error();
  const fs::path log = file.string() + "-wal";
  std::error_code ignored;
  const bool has_log =
      fs::is_regular_file(log, ignored) && fs::file_size(log, ignored) > 0;
  if (!has_log) {
    Database database = open_database(file, SQLITE_OPEN_READONLY, "immutable=1");
    if (database) limit_to(bytes_of(file), database.get());
    return database;
  }
  const TemporaryFolder folder;
  const fs::path copy = folder.path() / "take.sqlite";
  if (folder.path().empty() || !copy_with_log(file, log, copy)) {
    return Error{Errc::kDevice,
                 file.string(),
                 "its writer was killed, and there is no room for the copy in which its "
                 "log is put in order",
                 "free some space in " + fs::temp_directory_path(ignored).string() +
                     ", or set TMPDIR to a folder on another disk"};
  }
  {
    // Merges the log.
    const Database whole = open_database(copy, SQLITE_OPEN_READWRITE);
    if (!whole || !execute(whole.get(), "PRAGMA journal_mode=DELETE")) return Database();
  }
  // The folder is removed; the open file stays readable.
  Database database = open_database(copy, SQLITE_OPEN_READONLY, "immutable=1");
  if (database) limit_to(bytes_of(file), database.get());
  return database;
}

Database open_bytes(std::span<const std::byte> bytes) {
  Database database = open_database("memory", SQLITE_OPEN_READWRITE, "mode=memory");
  if (!database) return nullptr;
  // Pages are used in place. SQLite's interface has no const; READONLY protects the
  // bytes.
  auto* const data =
      reinterpret_cast<unsigned char*>(const_cast<std::byte*>(bytes.data()));
  const auto size = static_cast<sqlite3_int64>(bytes.size());
  const bool is_open =
      sqlite3_deserialize(
          database.get(), "main", data, size, size, SQLITE_DESERIALIZE_READONLY) ==
          SQLITE_OK &&
      execute(database.get(), "PRAGMA mmap_size=" + std::to_string(bytes.size()));
  if (!is_open) return nullptr;
  limit_to(bytes.size(), database.get());
  return database;
}

std::string bytes_of_database(sqlite3* database) {
  struct Free {
    void operator()(unsigned char* bytes) const { sqlite3_free(bytes); }
  };
  sqlite3_int64 size = 0;
  const std::unique_ptr<unsigned char, Free> bytes(
      sqlite3_serialize(database, "main", &size, 0));
  if (!bytes || size <= 0) return {};
  return {reinterpret_cast<const char*>(bytes.get()), static_cast<std::size_t>(size)};
}

bool has_schema(sqlite3* database, std::string_view schema) {
  Statement rows(database, "SELECT coalesce(sql, '') FROM sqlite_schema ORDER BY rowid");
  std::string found;
  // A text longer than the schema differs from it: reading stops.
  while (found.size() <= 2 * schema.size() && rows.next_row()) {
    found += without_blanks(rows.text(0));
    if (!found.empty() && found.back() != ';') found += ';';
  }
  return !rows.failed() && found == without_blanks(schema);
}

std::int64_t max_rows(const std::filesystem::path& file) {
  return static_cast<std::int64_t>(bytes_of(file));
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
  // A null pointer would bind NULL.
  sqlite3_bind_text(statement_.get(),
                    place + 1,
                    value.empty() ? "" : value.data(),
                    static_cast<int>(value.size()),
                    SQLITE_TRANSIENT);
}

void Statement::bind(int place, std::span<const std::byte> value) {
  // A null pointer would bind NULL, which a NOT NULL column rejects.
  const void* const bytes = value.empty() ? "" : static_cast<const void*>(value.data());
  sqlite3_bind_blob64(statement_.get(), place + 1, bytes, value.size(), SQLITE_TRANSIENT);
}

void Statement::bind(int place, std::nullptr_t) {
  sqlite3_bind_null(statement_.get(), place + 1);
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

void Statement::reset() {
  sqlite3_reset(statement_.get());
}

bool Statement::is_null(int column) const {
  return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
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

std::span<const std::byte> Statement::bytes(int column) const {
  const void* const bytes = sqlite3_column_blob(statement_.get(), column);
  const int size = sqlite3_column_bytes(statement_.get(), column);
  if (bytes == nullptr || size <= 0) return {};
  return {static_cast<const std::byte*>(bytes), static_cast<std::size_t>(size)};
}

}  // namespace marey::recordings
