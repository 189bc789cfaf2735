// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/session/session_copy.h"

#include <algorithm>
#include <system_error>

#include "core/base/in_quotes.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/text_reader.h"
#include "recordings/base/toml_reader.h"
#include "recordings/base/toml_writer.h"

namespace marey::recordings {
namespace fs = std::filesystem;

namespace {

/// Returns the text with an absolute `media`.
std::string with_absolute_media(std::string text,
                                TomlReader& root,
                                const fs::path& folder) {
  std::error_code ignored;
  fs::path media = fs::absolute(folder, ignored);
  if (root.has("media")) media /= root.text("media");
  TomlWriter line;
  line.text("media", media.lexically_normal().string());
  // Before the first key, or in place of its own line.
  const int at = root.has("media") ? root.line("media") : root.line("format");
  std::size_t begin = 0;
  for (int i = 1; i < at; ++i) begin = text.find('\n', begin) + 1;
  std::size_t end = begin;
  if (root.has("media")) end = std::min(text.find('\n', begin), text.size() - 1) + 1;
  return text.replace(begin, end - begin, line.str());
}

/// Returns the text with an absolute path of `lenses`. Unchanged if the line does not
/// contain the value literally.
std::string with_absolute_lenses(std::string text,
                                 const std::string& lenses,
                                 const Session& session) {
  std::size_t begin = 0;
  for (int i = 1; i < session.calibration.lenses_line; ++i) {
    begin = text.find('\n', begin) + 1;
  }
  std::error_code ignored;
  TomlWriter line;
  line.text(
      "lenses",
      fs::absolute(*session.calibration.lenses, ignored).lexically_normal().string());
  const std::string word = line.str().substr(0, line.str().find('\n'));
  const std::size_t key = text.find("lenses", begin);
  const std::size_t value = text.find(lenses, key);
  if (key == std::string::npos || value == std::string::npos || value == 0) return text;
  // The value with its quotation marks, one or three.
  std::size_t first = value;
  std::size_t last = value + lenses.size();
  while (first > 0 && (text[first - 1] == '"' || text[first - 1] == '\'')) --first;
  while (last < text.size() && (text[last] == '"' || text[last] == '\'')) ++last;
  return text.replace(key, last - key, word);
}

}  // namespace

Status copy_session(const Session& session, const fs::path& folder, const Trial& trial) {
  const fs::path copy = folder / "session.toml";
  std::error_code ignored;
  if (fs::exists(copy, ignored)) {
    const Result<Session> there = read_session(copy);
    if (!there) return there.error();
    const Trial* same = there->find(trial.name);
    if (same != nullptr && same->is_recorded && same->kind == trial.kind) return Done{};
    return bad_input(copy.string(),
                     "it has no trial " + in_quotes(trial.name) + " of the kind " +
                         in_quotes(std::string(name(trial.kind))) + " to record",
                     "add it there too, or record into another folder");
  }
  Result<std::string> text = read_file(session.file);
  if (!text) return text.error();
  const bool has_videos = std::any_of(session.trials.begin(),
                                      session.trials.end(),
                                      [](const Trial& t) { return !t.is_recorded; });
  if (has_videos) {
    Result<TomlDocument> document =
        parse_toml(*text, session.file.string(), "session.md");
    if (!document) return document.error();
    TomlReader root(*document);
    *text = with_absolute_media(std::move(*text), root, session.file.parent_path());
    // A folder's name may not be UTF-8, which TOML requires; and a `media` may have
    // lines.
    if (!parse_toml(*text, copy.string())) {
      return bad_input(session.file.string(),
                       "its videos cannot be named from another folder",
                       "give it a `media` of one line, and its folder a name in UTF-8");
    }
  }
  if (session.calibration.lenses) {
    Result<TomlDocument> document =
        parse_toml(*text, session.file.string(), "session.md");
    if (!document) return document.error();
    TomlReader root(*document);
    const std::string lenses = root.table("calibration").text("lenses");
    Session moved = session;
    moved.calibration.lenses_line = root.table("calibration").line("lenses");
    *text = with_absolute_lenses(std::move(*text), lenses, moved);
    Result<TomlDocument> again = parse_toml(*text, copy.string(), "session.md");
    std::string now;
    if (again) {
      TomlReader after(*again);
      now = after.table("calibration").text("lenses");
    }
    if (!fs::path(now).is_absolute()) {
      return bad_input(session.file.string(),
                       "its `lenses` cannot be named from another folder",
                       "give the file's whole path there");
    }
  }
  return write_file(copy, *text);
}

}  // namespace marey::recordings
