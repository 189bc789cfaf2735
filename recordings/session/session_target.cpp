// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/session/session_target.h"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/in_quotes.h"
#include "core/humanoid.h"
#include "core/nearest_word.h"
#include "recordings/base/number_text.h"
#include "recordings/base/word_text.h"

namespace marey::recordings {
namespace {

// Wide enough for all real targets; detects millimetres given as metres.
constexpr Limits kSize{0.005, 1.0, "m"};
constexpr Limits kGap{0.001, 1.0, "m"};
constexpr Limits kThickness{0.0, 0.2, "m"};
constexpr Limits kGridCount{1, 50};
constexpr Limits kSquareCount{2, 50};

/// OpenCV's dictionaries, with their numbers of markers.
struct KnownDictionary {
  std::string_view name;
  int markers = 0;
};
constexpr std::array<KnownDictionary, 21> kDictionaries{{
    {"DICT_4X4_50", 50},           {"DICT_4X4_100", 100},
    {"DICT_4X4_250", 250},         {"DICT_4X4_1000", 1000},
    {"DICT_5X5_50", 50},           {"DICT_5X5_100", 100},
    {"DICT_5X5_250", 250},         {"DICT_5X5_1000", 1000},
    {"DICT_6X6_50", 50},           {"DICT_6X6_100", 100},
    {"DICT_6X6_250", 250},         {"DICT_6X6_1000", 1000},
    {"DICT_7X7_50", 50},           {"DICT_7X7_100", 100},
    {"DICT_7X7_250", 250},         {"DICT_7X7_1000", 1000},
    {"DICT_ARUCO_ORIGINAL", 1024}, {"DICT_APRILTAG_16h5", 30},
    {"DICT_APRILTAG_25h9", 35},    {"DICT_APRILTAG_36h10", 2320},
    {"DICT_APRILTAG_36h11", 587},
}};

double read_thickness(TomlReader& reader) {
  return reader.has("thickness_m") ? reader.number("thickness_m", kThickness) : 0.0;
}

bool read_flag(TomlReader& reader, std::string_view key) {
  return reader.has(key) && reader.boolean(key);
}

AprilGrid read_aprilgrid(TomlReader& reader,
                         const KnownFamily& default_family,
                         Session& session) {
  reader.allow({"type",
                "family",
                "rows",
                "columns",
                "tag_size_m",
                "gap_m",
                "first_id",
                "thickness_m"});
  AprilGrid board;
  board.rows = reader.integer("rows", kGridCount);
  board.columns = reader.integer("columns", kGridCount);
  board.tag_size_m = reader.number("tag_size_m", kSize);
  board.gap_m = reader.number("gap_m", kGap);
  const KnownFamily family = read_family(reader, default_family);
  const int last_id = family.tags - 1;
  board.first_id = reader.integer("first_id", {0, static_cast<double>(last_id)});
  board.thickness_m = read_thickness(reader);
  const int last_on_board = board.first_id + board.tag_count() - 1;
  if (last_on_board > last_id) {
    reader.fail(
        "first_id",
        with_number("the board would need tags up to id ", last_on_board) +
            with_number(", but " + std::string(family.name) + " ends at ", last_id),
        "correct rows, columns or first_id, or the `family` of [tags]");
  }
  if (!reader.ok()) return board;
  for (int i = 0; i < board.tag_count(); ++i) {
    use_tag(family, TagId{board.first_id + i}, session);
  }
  return board;
}

KnownDictionary read_dictionary(TomlReader& reader) {
  const std::string word = reader.text("dictionary");
  std::vector<std::string_view> names;
  for (const KnownDictionary& dictionary : kDictionaries) {
    if (dictionary.name == word) return dictionary;
    names.push_back(dictionary.name);
  }
  reader.fail(
      "dictionary", "unknown dictionary " + in_quotes(word), suggestion(word, names));
  return kDictionaries[0];
}

/// A board of two squares by two has a single corner, which is not enough.
void check_squares(TomlReader& reader, int rows, int columns) {
  if (!reader.ok() || std::max(rows, columns) > 2) return;
  reader.fail("rows",
              "a board of 2 x 2 squares has a single corner",
              "count the squares, not their corners; use a larger board");
}

CharucoBoard read_charuco(TomlReader& reader) {
  reader.allow({"type",
                "rows",
                "columns",
                "square_size_m",
                "marker_size_m",
                "dictionary",
                "legacy",
                "inverted",
                "two_sided",
                "thickness_m"});
  CharucoBoard board;
  board.rows = reader.integer("rows", kSquareCount);
  board.columns = reader.integer("columns", kSquareCount);
  board.square_size_m = reader.number("square_size_m", kSize);
  board.marker_size_m = reader.number("marker_size_m", kSize);
  const KnownDictionary dictionary = read_dictionary(reader);
  board.dictionary = dictionary.name;
  board.is_legacy = read_flag(reader, "legacy");
  board.is_inverted = read_flag(reader, "inverted");
  board.is_two_sided = read_flag(reader, "two_sided");
  board.thickness_m = read_thickness(reader);
  check_squares(reader, board.rows, board.columns);
  if (reader.ok() && board.marker_size_m >= board.square_size_m) {
    reader.fail("marker_size_m",
                "a marker is as large as its square, or larger",
                "give the edge of a marker's square of bits, its frame included");
  }
  if (reader.ok() && board.marker_count() > dictionary.markers) {
    reader.fail("dictionary",
                with_number("the board needs ", board.marker_count()) +
                    with_number(" markers, and " + board.dictionary + " has ",
                                dictionary.markers),
                "correct rows, columns or dictionary");
  }
  return board;
}

Chessboard read_chessboard(TomlReader& reader) {
  reader.allow({"type", "rows", "columns", "square_size_m", "thickness_m"});
  Chessboard board;
  board.rows = reader.integer("rows", kSquareCount);
  board.columns = reader.integer("columns", kSquareCount);
  board.square_size_m = reader.number("square_size_m", kSize);
  board.thickness_m = read_thickness(reader);
  check_squares(reader, board.rows, board.columns);
  if (reader.ok() && (board.rows + board.columns) % 2 == 0) {
    reader.fail(
        "rows",
        with_number(with_number("a chessboard of ", board.columns) + " x ", board.rows) +
            " squares looks the same after half a turn: no two cameras could "
            "agree on it",
        "count the squares, not their corners; of rows and columns one must be "
        "even and one odd");
  }
  return board;
}

CalibrationTarget read_board(TomlReader& reader,
                             const KnownFamily& default_family,
                             Session& session) {
  constexpr std::array<std::string_view, 3> kTypes{"aprilgrid", "charuco", "chessboard"};
  const std::string type = reader.has("type") ? reader.text("type") : "aprilgrid";
  if (type == "charuco") return read_charuco(reader);
  if (type == "chessboard") return read_chessboard(reader);
  if (type != "aprilgrid") {
    reader.fail(
        "type", "unknown board type " + in_quotes(type), suggestion(type, kTypes));
  }
  return read_aprilgrid(reader, default_family, session);
}

Wand read_wand(TomlReader& wand, const KnownFamily& default_family, Session& session) {
  wand.allow({"family", "tag", "segment"});
  const KnownFamily usual = read_family(wand, default_family);
  Wand body;
  if (wand.has("segment")) {
    if (wand.has("tag") || wand.has("family")) {
      wand.fail("segment",
                "the wand has tags of its own and is a segment of the body",
                "keep one: the tags of a segment are those of [[tags.tag]]");
    }
    return body;
  }
  if (!wand.has("tag")) {
    wand.fail("",
              "no tag is on the wand",
              "add a [[wand.tag]] with id and size_m for each, or "
              "name the segment of the body that serves as one");
  }
  for (TomlReader& reader : wand.tables("tag")) {
    reader.allow({"id", "size_m", "family"});
    const KnownFamily family = read_family(reader, usual);
    const TagId id{reader.integer("id", {0, family.tags - 1.0})};
    const double size_m = reader.number("size_m", kSize);
    if (!reader.ok()) return body;
    const auto same = [&](const Wand::Tag& tag) { return tag.id == id; };
    if (std::any_of(body.tags.begin(), body.tags.end(), same)) {
      reader.fail("id",
                  with_number("tag ", number(id)) + " is on the wand twice",
                  "remove one, or correct its id");
    }
    body.tags.push_back({id, size_m});
    use_tag(family, id, session);
  }
  std::sort(body.tags.begin(), body.tags.end(), [](const auto& a, const auto& b) {
    return a.id < b.id;
  });
  return body;
}

}  // namespace

CalibrationTarget read_target(TomlReader& root,
                              const KnownFamily& default_family,
                              Session& session) {
  if (root.has("wand") && root.has("board")) {
    root.fail("wand",
              "the session has a board and a wand",
              "keep the one that the calibration trial shows");
  }
  if (root.has("wand")) {
    TomlReader wand = root.table("wand");
    return read_wand(wand, default_family, session);
  }
  TomlReader board = root.table("board");
  return read_board(board, default_family, session);
}

void read_wand_segment(TomlReader& root, Session& session) {
  auto* body = std::get_if<Wand>(&session.target);
  if (body == nullptr || !root.has("wand")) return;
  TomlReader reader = root.table("wand");
  if (!reader.has("segment")) return;
  const std::string segment = reader.text("segment");
  if (!reader.ok()) return;
  const std::optional<HumanBone> bone = human_bone(segment);
  if (!bone) {
    reader.fail(
        "segment", "unknown segment " + in_quotes(segment), bone_suggestion(segment));
    return;
  }
  for (const TagOnSegment& tag : session.tags) {
    if (tag.segment == *bone) body->tags.push_back({tag.id, tag.size_m});
  }
  if (body->tags.empty()) {
    reader.fail("segment",
                "no tag is on the segment " + in_quotes(segment),
                "add a [[tags.tag]] with id, segment and size_m for each of its tags");
  }
  std::sort(body->tags.begin(), body->tags.end(), [](const auto& a, const auto& b) {
    return a.id < b.id;
  });
}

std::optional<std::string> place_on_target(const CalibrationTarget& target,
                                           TagId id,
                                           const KnownFamily& family) {
  if (const auto* grid = std::get_if<AprilGrid>(&target)) {
    if (grid->contains(id)) return "on the board";
  } else if (const auto* wand = std::get_if<Wand>(&target)) {
    const auto same = [&](const Wand::Tag& tag) { return tag.id == id; };
    if (std::any_of(wand->tags.begin(), wand->tags.end(), same)) return "on the wand";
  } else if (const auto* charuco = std::get_if<CharucoBoard>(&target)) {
    // OpenCV's dictionaries of AprilTags are the families of that name.
    constexpr std::string_view kPrefix = "DICT_APRILTAG_";
    const std::string_view name = charuco->dictionary;
    if (name.starts_with(kPrefix) && number(id) < charuco->marker_count() &&
        "tag" + std::string(name.substr(kPrefix.size())) == family.name) {
      return "on the board";
    }
  }
  return std::nullopt;
}

}  // namespace marey::recordings
