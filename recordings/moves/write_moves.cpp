// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/moves/write_moves.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/in_quotes.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/sqlite.h"
#include "recordings/body/constraints_file.h"
#include "recordings/moves/check_clip.h"
#include "recordings/moves/clip_figures.h"
#include "recordings/moves/moves_schema.h"
#include "recordings/moves/pack_frames.h"
#include "recordings/moves/page_sums.h"

namespace marey::recordings {
namespace {

Error unwritable(const std::string& file, const MotionClip& clip, std::string cause) {
  return bad_input(file + ": clip " + in_quotes(clip.name),
                   std::move(cause),
                   "correct the motion or recipe that it is made from");
}

/// Texts of a clip's constraints.
struct ConstraintTexts {
  std::string xml;      ///< Empty: there are none.
  std::string turning;  ///< Ids of supports that turn, which XML does not hold, as lines.
};

Result<ConstraintTexts> constraint_texts(const ConstraintSet& set) {
  ConstraintTexts out;
  if (set.constraints.empty() && set.unknown_xml.empty()) return out;
  auto xml = constraints_text(set);
  if (!xml) return xml.error();
  out.xml = *std::move(xml);
  for (const Constraint& constraint : set.constraints) {
    const auto* support = std::get_if<Support>(&constraint.goal);
    if (support != nullptr && support->turns) out.turning += constraint.id + "\n";
  }
  return out;
}

Status check_moves(const MoveSet& moves, const std::string& file) {
  if (const auto problem = layout_problem(moves.layout)) {
    return bad_input(file, *problem, "report it with the command");
  }
  const MotionClip* last = nullptr;
  for (const MotionClip& clip : moves.clips) {
    if (auto problem = clip_problem(clip)) return unwritable(file, clip, *problem);
    if (last != nullptr && clip.name == last->name) {
      return bad_input(file + ": clip " + in_quotes(clip.name),
                       "two clips have this name",
                       "give each a name of its own");
    }
    if (last != nullptr && clip.name < last->name) {
      return unwritable(file, clip, "the clips are not in the order of their names");
    }
    last = &clip;
  }
  return Done{};
}

void bind_blob(Statement& row, int place, std::string_view blob) {
  row.bind(place, std::as_bytes(std::span(blob)));
  row.bind(place + 1, std::string_view(blob_sum(blob)));
}

/// Fills the tables of a new database.
class MovesWriter {
 public:
  explicit MovesWriter(sqlite3* database)
      : clip_(database, "INSERT INTO clip VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)"),
        tag_(database, "INSERT INTO tag VALUES(?,?)"),
        note_(database, "INSERT INTO note VALUES(?,?,?,?,?)") {}

  [[nodiscard]] bool add(std::int64_t number,
                         const MotionClip& clip,
                         const ConstraintTexts& texts) {
    return add_clip(number, clip, texts) && add_words(number, clip);
  }

 private:
  bool add_clip(std::int64_t number,
                const MotionClip& clip,
                const ConstraintTexts& texts) {
    clip_.bind(0, number);
    clip_.bind(1, std::string_view(clip.name));
    clip_.bind(2, std::string_view(clip.body));
    clip_.bind(3, static_cast<double>(clip.leg_length_m));
    clip_.bind(4, static_cast<double>(clip.rate_hz));
    clip_.bind(5, static_cast<std::int64_t>(clip.frames.size()));
    clip_.bind(6, clip.duration_s());
    clip_.bind(7, std::int64_t{clip.loops ? 1 : 0});
    clip_.bind(8, mean_speed_m_s(clip));
    clip_.bind(9, std::string_view(supports_of(clip)));
    clip_.bind(10, std::string_view(clip.document_sha256));
    clip_.bind(11, std::string_view(clip.recipe_sha256));
    clip_.bind(12, std::string_view(texts.xml));
    clip_.bind(13, std::string_view(texts.turning));
    bind_blob(clip_, 14, pack_contacts(clip.contacts));
    bind_blob(clip_, 16, pack_frames(clip.frames, clip.path));
    return clip_.run();
  }

  bool add_words(std::int64_t number, const MotionClip& clip) {
    for (const std::string& tag : clip.tags) {
      tag_.bind(0, number);
      tag_.bind(1, std::string_view(tag));
      if (!tag_.run()) return false;
    }
    std::int64_t place = 0;
    for (const Annotation& note : clip.notes) {
      note_.bind(0, number);
      note_.bind(1, place++);
      note_.bind(2, note.start_s);
      note_.bind(3, note.end_s);
      note_.bind(4, std::string_view(note.text));
      if (!note_.run()) return false;
    }
    return true;
  }

  Statement clip_;
  Statement tag_;
  Statement note_;
};

/// Opens a new database in memory, with the tables and reserved bytes in each page.
Database begin_moves() {
  Database database =
      open_database("moves", SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, "mode=memory");
  if (!database) return nullptr;
  int reserved = kPageSumBytes;
  const bool is_reserved =
      sqlite3_file_control(
          database.get(), "main", SQLITE_FCNTL_RESERVE_BYTES, &reserved) == SQLITE_OK;
  // Overwriting deleted content keeps stale bytes out of the pages.
  const bool is_made =
      is_reserved &&
      execute(database.get(),
              "PRAGMA secure_delete=ON; PRAGMA encoding='UTF-8'; PRAGMA page_size=" +
                  std::to_string(kMovesPageBytes) +
                  "; PRAGMA application_id=" + std::to_string(kMovesApplication) +
                  "; PRAGMA user_version=" + std::to_string(kMovesVersion) + "; BEGIN") &&
      execute(database.get(), kMovesSchema);
  return is_made ? std::move(database) : nullptr;
}

bool add_base(sqlite3* database, const MoveSet& moves) {
  Statement row(database, "INSERT INTO base VALUES(?,?)");
  const std::string layout = pack_layout(moves.layout);
  row.bind(0, std::as_bytes(std::span(layout)));
  row.bind(1, static_cast<std::int64_t>(moves.clips.size()));
  return row.run();
}

/// Returns the bytes of the database, without sums of pages; empty: no memory is left.
std::string database_of(const MoveSet& moves, std::span<const ConstraintTexts> texts) {
  const Database database = begin_moves();
  if (!database || !add_base(database.get(), moves)) return {};
  {
    MovesWriter writer(database.get());
    for (std::size_t i = 0; i < moves.clips.size(); ++i) {
      if (!writer.add(static_cast<std::int64_t>(i), moves.clips[i], texts[i])) return {};
    }
  }
  if (!execute(database.get(), "COMMIT")) return {};
  return bytes_of_database(database.get());
}

}  // namespace

Result<std::string> moves_bytes(const MoveSet& moves, const std::string& file) {
  if (const Status ok = check_moves(moves, file); !ok) return ok.error();
  std::vector<ConstraintTexts> texts;
  for (const MotionClip& clip : moves.clips) {
    auto text = constraint_texts(clip.constraints);
    if (!text) {
      return unwritable(file, clip, text.error().where + " " + text.error().cause);
    }
    texts.push_back(*std::move(text));
  }
  std::string bytes = database_of(moves, texts);
  if (bytes.empty() || bytes.size() % kMovesPageBytes != 0) {
    return Error{Errc::kDevice,
                 file,
                 "no memory is left for its clips",
                 "put them into several files"};
  }
  write_page_sums(bytes, kMovesPageBytes);
  return bytes;
}

Status write_moves(const std::filesystem::path& path, const MoveSet& moves) {
  const auto bytes = moves_bytes(moves, path.string());
  if (!bytes) return bytes.error();
  return write_file(path, *bytes);
}

}  // namespace marey::recordings
