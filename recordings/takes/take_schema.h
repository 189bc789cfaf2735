// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to recordings/: content of a take's file (docs/formats/takes.md).
namespace marey::recordings {

inline constexpr int kTakeApplication = 0x6d617265;  ///< "mare", SQLite's application_id.
inline constexpr int kTakeVersion = 1;               ///< SQLite's user_version.

inline constexpr const char* kTakeSchema = R"(
CREATE TABLE take(
  trial TEXT NOT NULL,
  started TEXT NOT NULL,
  finished INTEGER NOT NULL);
CREATE TABLE camera(
  camera INTEGER PRIMARY KEY,
  name TEXT NOT NULL,
  file TEXT NOT NULL,
  width_px INTEGER NOT NULL,
  height_px INTEGER NOT NULL,
  rate_hz REAL NOT NULL,
  device TEXT NOT NULL,
  settings TEXT NOT NULL);
CREATE TABLE frame(
  camera INTEGER NOT NULL REFERENCES camera,
  number INTEGER NOT NULL,
  time_ns INTEGER NOT NULL,
  sequence INTEGER NOT NULL,
  dropped_before INTEGER NOT NULL,
  time_is_arrival INTEGER NOT NULL,
  damaged INTEGER NOT NULL,
  PRIMARY KEY(camera, number)) WITHOUT ROWID;
CREATE TABLE event(
  camera INTEGER NOT NULL REFERENCES camera,
  time_ns INTEGER NOT NULL,
  text TEXT NOT NULL);
)";

}  // namespace marey::recordings
