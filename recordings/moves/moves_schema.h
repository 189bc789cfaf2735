// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

// Private to recordings/moves: content of a base of clips (docs/formats/moves.md).
namespace marey::recordings {

inline constexpr int kMovesApplication = 0x6d61726d;  ///< "marm", application_id.
inline constexpr int kMovesVersion = 1;               ///< SQLite's user_version.
/// Small, because each table and index fills at least one page.
inline constexpr std::size_t kMovesPageBytes = 1024;

inline constexpr const char* kMovesSchema = R"(
CREATE TABLE base(
  layout BLOB NOT NULL,
  clips INTEGER NOT NULL
) STRICT;
CREATE TABLE clip(
  number INTEGER PRIMARY KEY,
  name TEXT NOT NULL,
  body TEXT NOT NULL,
  leg_length_m REAL NOT NULL,
  rate_hz REAL NOT NULL,
  frames INTEGER NOT NULL,
  seconds REAL NOT NULL,
  loops INTEGER NOT NULL,
  speed_m_s REAL NOT NULL,
  supports TEXT NOT NULL,
  document_sha256 TEXT NOT NULL,
  recipe_sha256 TEXT NOT NULL,
  constraints TEXT NOT NULL,
  turning TEXT NOT NULL,
  contacts BLOB NOT NULL,
  contacts_xxh3 TEXT NOT NULL,
  motion BLOB NOT NULL,
  motion_xxh3 TEXT NOT NULL
) STRICT;
CREATE TABLE tag(
  clip INTEGER NOT NULL, name TEXT NOT NULL, PRIMARY KEY(clip, name)
) STRICT, WITHOUT ROWID;
CREATE TABLE note(
  clip INTEGER NOT NULL, place INTEGER NOT NULL, start_s REAL NOT NULL,
  end_s REAL NOT NULL, text TEXT NOT NULL, PRIMARY KEY(clip, place)
) STRICT, WITHOUT ROWID;
CREATE UNIQUE INDEX clip_name ON clip(name);
CREATE INDEX clip_speed ON clip(speed_m_s);
CREATE INDEX clip_supports ON clip(supports);
CREATE INDEX tag_name ON tag(name, clip);
)";

}  // namespace marey::recordings
