// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/moves/read_moves.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/in_quotes.h"
#include "recordings/base/mapped_file.h"
#include "recordings/base/sqlite.h"
#include "recordings/body/constraints_file.h"
#include "recordings/moves/check_clip.h"
#include "recordings/moves/moves_schema.h"
#include "recordings/moves/pack_frames.h"
#include "recordings/moves/page_sums.h"

namespace marey::recordings {
namespace {

constexpr const char* kMakeAgain = "copy it again, or make it again: marey base build";

/// Returns a number of SQLite's header: most significant byte first.
std::uint32_t header_number(std::string_view bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    value = value << 8U | static_cast<unsigned char>(bytes[offset + k]);
  }
  return value;
}

// Offsets in SQLite's header of 100 bytes.
constexpr std::size_t kHeaderBytes = 100;
constexpr std::size_t kPagesOffset = 28;
constexpr std::size_t kVersionOffset = 60;
constexpr std::size_t kApplicationOffset = 68;

/// Checks the kind and version of a file, that it is whole, and the sums of its pages.
Status check_pages(std::string_view bytes, const std::string& file) {
  constexpr std::string_view kMagic("SQLite format 3\0", 16);
  const bool is_moves =
      bytes.size() >= kHeaderBytes && bytes.substr(0, kMagic.size()) == kMagic &&
      header_number(bytes, kApplicationOffset) == std::uint32_t{kMovesApplication};
  if (!is_moves) {
    return bad_input(
        file, "it is no base of motion clips", "name a file that marey base build made");
  }
  const std::uint32_t version = header_number(bytes, kVersionOffset);
  if (version > std::uint32_t{kMovesVersion}) {
    return bad_input(file,
                     "it was made by a newer version of marey (format " +
                         std::to_string(version) + ", this version reads " +
                         std::to_string(kMovesVersion) + ")",
                     "install that version, or make the file again: marey base build");
  }
  const std::uint64_t pages = header_number(bytes, kPagesOffset);
  if (bytes.size() != pages * kMovesPageBytes) {
    return bad_input(file,
                     "it is damaged: it has " + std::to_string(bytes.size()) +
                         " bytes instead of " + std::to_string(pages * kMovesPageBytes),
                     kMakeAgain);
  }
  if (const auto page = find_damaged_page(bytes, kMovesPageBytes)) {
    return bad_input(file,
                     "it is damaged: page " + std::to_string(*page) + " of " +
                         std::to_string(pages) + " differs from its sum",
                     kMakeAgain);
  }
  return Done{};
}

std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Reads the tables of one file.
class MovesReader {
 public:
  MovesReader(sqlite3* database, std::string file, std::size_t bytes)
      : database_(database), file_(std::move(file)), left_(bytes) {}

  Result<MoveSet> read() {
    if (Status ok = read_base(); !ok) return ok.error();
    if (Status ok = read_clips(); !ok) return ok.error();
    if (!read_tags() || !read_notes()) return damaged("its tables are not in order");
    for (const MotionClip& clip : out_.clips) {
      if (const auto problem = clip_problem(clip)) return damaged(clip, *problem);
    }
    return std::move(out_);
  }

 private:
  [[nodiscard]] Error damaged(const std::string& cause) const {
    return bad_input(file_, "it is damaged: " + cause, kMakeAgain);
  }
  [[nodiscard]] Error damaged(const MotionClip& clip, const std::string& cause) const {
    return bad_input(
        file_ + ": clip " + in_quotes(clip.name), "it is damaged: " + cause, kMakeAgain);
  }

  Status read_base() {
    Statement row(database_, "SELECT layout, clips FROM base");
    if (!row.next_row()) return damaged("its head is missing");
    const auto layout = unpack_layout(as_text(row.bytes(0)));
    if (!layout) return damaged("the layout of its postures has another length");
    if (const auto problem = layout_problem(*layout)) return damaged(*problem);
    out_.layout = *layout;
    clips_ = row.integer(1);
    if (row.next_row() || row.failed()) return damaged("it has two heads");
    return Done{};
  }

  Status read_clips() {
    Statement rows(database_,
                   "SELECT number, name, body, leg_length_m, rate_hz, frames, loops, "
                   "document_sha256, recipe_sha256, constraints, turning, contacts, "
                   "contacts_xxh3, motion, motion_xxh3 FROM clip ORDER BY number");
    while (rows.next_row()) {
      const auto number = static_cast<std::int64_t>(out_.clips.size());
      if (rows.integer(0) != number || number >= clips_) break;
      MotionClip clip;
      if (Status ok = read_clip(rows, clip); !ok) return ok;
      if (!out_.clips.empty() && clip.name <= out_.clips.back().name) {
        return damaged(clip, "its name is not in order");
      }
      out_.clips.push_back(std::move(clip));
    }
    const bool is_whole =
        !rows.failed() && clips_ == static_cast<std::int64_t>(out_.clips.size());
    if (is_whole) return Done{};
    return damaged("it holds another number of clips than its head has");
  }

  /// Counts bytes that were read. Returns false if they are more than the file has: rows
  /// of a damaged tree may share pages.
  bool count(std::size_t bytes) {
    if (bytes > left_) return false;
    left_ -= bytes;
    return true;
  }

  Status read_clip(const Statement& row, MotionClip& clip) {
    clip.name = row.text(1);
    const std::size_t bytes = row.bytes(9).size() + row.bytes(10).size() +
                              row.bytes(11).size() + row.bytes(13).size();
    if (!count(bytes)) return damaged(clip, "its rows share pages");
    clip.body = row.text(2);
    clip.leg_length_m = static_cast<float>(row.number(3));
    clip.rate_hz = static_cast<float>(row.number(4));
    clip.loops = row.integer(6) != 0;
    clip.document_sha256 = row.text(7);
    clip.recipe_sha256 = row.text(8);
    if (Status ok = read_constraints(row, clip); !ok) return ok;
    return read_numbers(row, clip);
  }

  Status read_constraints(const Statement& row, MotionClip& clip) const {
    const std::string xml = row.text(9);
    std::string turning = row.text(10);
    if (!xml.empty()) {
      auto set = parse_constraints(xml, file_);
      if (!set) return damaged(clip, "its constraints: " + set.error().cause);
      clip.constraints = std::move(set->set);
    }
    for (std::size_t end = turning.find('\n'); end != std::string::npos;
         end = turning.find('\n')) {
      Constraint* const found = clip.constraints.find(turning.substr(0, end));
      auto* const support =
          found == nullptr ? nullptr : std::get_if<Support>(&found->goal);
      if (support == nullptr) return damaged(clip, "a support that turns is missing");
      support->turns = true;
      turning.erase(0, end + 1);
    }
    return Done{};
  }

  Status read_numbers(const Statement& row, MotionClip& clip) const {
    const std::string_view contacts = as_text(row.bytes(11));
    if (blob_sum(contacts) != row.text(12)) {
      return damaged(clip, "its contacts differ from their sum");
    }
    auto spans = unpack_contacts(contacts);
    if (!spans) return damaged(clip, "its contacts have another length");
    clip.contacts = *std::move(spans);
    const std::string_view motion = as_text(row.bytes(13));
    if (blob_sum(motion) != row.text(14)) {
      return damaged(clip, "its frames differ from their sum");
    }
    const std::int64_t frames = row.integer(5);
    if (frames < 0 || static_cast<std::uint64_t>(frames) != motion.size() / kFrameBytes) {
      return damaged(clip, "it has another number of frames than it states");
    }
    auto unpacked = unpack_frames(motion);
    if (!unpacked) {
      return damaged(clip, "a frame holds numbers that are not finite or no rotation");
    }
    clip.frames = std::move(unpacked->frames);
    clip.path = std::move(unpacked->path);
    return Done{};
  }

  /// Returns the clip of a row; null without one.
  [[nodiscard]] MotionClip* clip_at(std::int64_t number) {
    const bool is_clip =
        number >= 0 && static_cast<std::uint64_t>(number) < out_.clips.size();
    return is_clip ? &out_.clips[static_cast<std::size_t>(number)] : nullptr;
  }

  /// Pages of a damaged tree may reference each other in a cycle: rows out of order end
  /// the reading.
  bool read_tags() {
    Statement rows(database_, "SELECT clip, name FROM tag ORDER BY clip, name");
    std::int64_t last = -1;
    while (rows.next_row()) {
      MotionClip* const clip = clip_at(rows.integer(0));
      if (clip == nullptr || rows.integer(0) < last) return false;
      last = rows.integer(0);
      std::string name = rows.text(1);
      if (!count(name.size()) || (!clip->tags.empty() && name <= clip->tags.back()))
        return false;
      clip->tags.push_back(std::move(name));
    }
    return !rows.failed();
  }

  bool read_notes() {
    Statement rows(database_,
                   "SELECT clip, place, start_s, end_s, text FROM note "
                   "ORDER BY clip, place");
    std::int64_t last = -1;
    while (rows.next_row()) {
      MotionClip* const clip = clip_at(rows.integer(0));
      if (clip == nullptr || rows.integer(0) < last) return false;
      last = rows.integer(0);
      if (rows.integer(1) != static_cast<std::int64_t>(clip->notes.size())) return false;
      std::string text = rows.text(4);
      if (!count(text.size())) return false;
      clip->notes.push_back({std::move(text), rows.number(2), rows.number(3)});
    }
    return !rows.failed();
  }

  sqlite3* database_;
  std::string file_;
  std::size_t left_;        ///< Bytes that may still be read.
  std::int64_t clips_ = 0;  ///< Number of clips in the head.
  MoveSet out_;
};

}  // namespace

Result<MoveSet> parse_moves(std::string_view bytes, const std::string& file) {
  if (const Status ok = check_pages(bytes, file); !ok) return ok.error();
  const Database database = open_bytes(std::as_bytes(std::span(bytes)));
  const bool is_moves = database &&
                        setting_of(database.get(), "user_version") == kMovesVersion &&
                        has_schema(database.get(), kMovesSchema);
  if (!is_moves) {
    return bad_input(
        file, "it is damaged: its tables are not those of clips", kMakeAgain);
  }
  return MovesReader(database.get(), file, bytes.size()).read();
}

Result<MoveSet> read_moves(const std::filesystem::path& path) {
  const auto file = MappedFile::open(path);
  if (!file) return file.error();
  return parse_moves(as_text(file->bytes()), path.string());
}

}  // namespace marey::recordings
