// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to recordings/: content of a live take's file (docs/formats/live_takes.md).
namespace marey::recordings {

inline constexpr int kLiveTakeApplication = 0x6d61726c;  ///< "marl", application_id.
inline constexpr int kLiveTakeVersion = 1;               ///< SQLite's user_version.

inline constexpr const char* kLiveTakeSchema = R"(
CREATE TABLE live(
  session TEXT NOT NULL,
  started TEXT NOT NULL,
  rate_hz REAL NOT NULL,
  settings TEXT NOT NULL,
  finished INTEGER NOT NULL);
CREATE TABLE camera(
  camera INTEGER PRIMARY KEY,
  name TEXT NOT NULL);
CREATE TABLE instant(
  number INTEGER PRIMARY KEY,
  time_ns INTEGER NOT NULL,
  views BLOB NOT NULL,
  requests TEXT NOT NULL,
  results BLOB NOT NULL);
)";

}  // namespace marey::recordings
