// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <variant>

#include <nlohmann/json.hpp>

#include "app/print/print_commands.h"
#include "app/shell/option_checks.h"
#include "capture/tags/tag_pattern.h"
#include "core/base/extension.h"
#include "recordings/print/pdf_write.h"
#include "recordings/print/print_tags.h"
#include "recordings/session/session.h"

namespace marey::app {
namespace {

using Json = nlohmann::ordered_json;
using recordings::NamedTag;
using recordings::PrintedDocument;
using recordings::TagToPrint;

recordings::Paper paper_of(const PrintArguments& args) {
  recordings::Paper paper = args.paper;
  paper.margin_m = args.margin_m;
  return paper;
}

Result<TagToPrint> tag_to_print(const std::string& family,
                                const NamedTag& tag,
                                double size_m,
                                std::map<std::string, TagFamilyShape>& shapes) {
  if (!shapes.contains(family)) {
    auto shape = capture::tag_family_shape(family);
    if (!shape) return shape.error();
    shapes[family] = *std::move(shape);
  }
  auto patterns = capture::tag_patterns(family, std::span(&tag.id, 1));
  if (!patterns) return patterns.error();
  return TagToPrint{tag.id, tag.segment, size_m, shapes[family], patterns->front()};
}

Result<std::vector<TagToPrint>> tags_of_arguments(const PrintArguments& args) {
  constexpr double kMin_m = 0.005;
  constexpr double kMax_m = 1.0;
  if (args.size_m < kMin_m || args.size_m > kMax_m) {
    return bad_input(
        "--size", "a tag's size must be from 5 mm to 1 m", "check number and unit");
  }
  std::map<std::string, TagFamilyShape> shapes;
  std::vector<TagToPrint> tags;
  for (const NamedTag& tag : args.ids) {
    auto one = tag_to_print(args.family, tag, args.size_m, shapes);
    if (!one) return one.error();
    tags.push_back(*std::move(one));
  }
  return tags;
}

Result<std::vector<TagToPrint>> tags_of_session(const PrintArguments& args) {
  const auto session = recordings::read_session(args.session);
  if (!session) return session.error();
  const auto wanted = [&](TagId id) {
    return args.ids.empty() ||
           std::any_of(args.ids.begin(), args.ids.end(), [&](const NamedTag& named) {
             return named.id == id;
           });
  };
  std::map<std::string, TagFamilyShape> shapes;
  std::vector<TagToPrint> tags;
  for (const TagOnSegment& tag : session->tags) {
    if (!wanted(tag.id)) continue;
    auto one = tag_to_print(
        session->family_of(tag.id), {tag.id, tag.segment}, tag.size_m, shapes);
    if (!one) return one.error();
    tags.push_back(*std::move(one));
  }
  for (const NamedTag& named : args.ids) {
    const auto same = [&](const TagToPrint& tag) { return tag.id == named.id; };
    if (std::any_of(tags.begin(), tags.end(), same)) continue;
    return bad_input(session->file.string(),
                     "no tag " + std::to_string(number(named.id)) + " is on the body",
                     "choose --ids among the session's, or leave them out");
  }
  return tags;
}

Json place_of(const recordings::PrintedTag& tag, const recordings::PrintedPage& page) {
  const auto& s = tag.square;
  return {{"id", number(tag.id)},
          {"centre_m", {s.middle().x, page.height_m - s.middle().y}},
          {"size_m", s.width()}};
}

/// Returns the layout of the pages, for both commands. Positions are from the bottom left
/// corner.
Json summary(const PrintArguments& args, const PrintedDocument& document) {
  Json pages = Json::array();
  for (const recordings::PrintedPage& page : document.pages) {
    Json tags = Json::array();
    for (const auto& tag : page.tags) tags.push_back(place_of(tag, page));
    pages.push_back(
        {{"width_m", page.width_m},
         {"height_m", page.height_m},
         {"ruler_start_m", {page.ruler_start.x, page.height_m - page.ruler_start.y}},
         {"tags", tags}});
  }
  return {{"file", args.out.string()}, {"title", document.title}, {"pages", pages}};
}

Exit write(const PrintArguments& args,
           const Result<PrintedDocument>& document,
           const Json& more,
           Console& console) {
  if (!document) return console.fail(document.error());
  if (kind_by_extension(args.out) != ".pdf") {
    return console.fail(
        bad_input(args.out.string(), "pages can only be written as PDF", "name it .pdf"));
  }
  if (const Status ok = check_out_file(args.out); !ok) return console.fail(ok.error());
  const Status written = recordings::write_pdf(args.out, *document);
  if (!written) return console.fail(written.error());
  const std::size_t pages = document->pages.size();
  console.say(args.out.string() + ": " + std::to_string(pages) +
              (pages == 1 ? " page" : " pages") +
              ". Print at 100 % (\"actual size\") and measure the 100 mm line");
  if (args.json) {
    Json all = summary(args, *document);
    all.update(more);
    constexpr auto kReplace = Json::error_handler_t::replace;
    std::printf("%s\n", all.dump(2, ' ', false, kReplace).c_str());
  }
  return Exit::kOk;
}

Exit print_board(const PrintArguments& args,
                 const CharucoBoard& board,
                 Console& console) {
  const auto patterns = capture::aruco_patterns(board.dictionary, board.marker_count());
  if (!patterns) return console.fail(patterns.error());
  const auto document =
      recordings::lay_out_board(board, *patterns, {paper_of(args), args.one_page});
  const Json more{{"board",
                   {{"type", "charuco"},
                    {"rows", board.rows},
                    {"columns", board.columns},
                    {"square_size_m", board.square_size_m},
                    {"marker_size_m", board.marker_size_m},
                    {"dictionary", board.dictionary},
                    {"legacy", board.is_legacy},
                    {"thickness_m", board.thickness_m}}},
                  {"board_toml", recordings::board_table(board)}};
  return write(args, document, more, console);
}

Exit print_board(const PrintArguments& args, const Chessboard& board, Console& console) {
  const auto document = recordings::lay_out_board(board, {paper_of(args), args.one_page});
  const Json more{{"board",
                   {{"type", "chessboard"},
                    {"rows", board.rows},
                    {"columns", board.columns},
                    {"square_size_m", board.square_size_m},
                    {"thickness_m", board.thickness_m}}},
                  {"board_toml", recordings::board_table(board)}};
  return write(args, document, more, console);
}

Exit print_board(const PrintArguments& args,
                 const AprilGrid& grid,
                 const std::string& family,
                 Console& console) {
  const auto shape = capture::tag_family_shape(family);
  if (!shape) return console.fail(shape.error());
  std::vector<TagId> ids;
  for (int i = 0; i < grid.tag_count(); ++i) ids.push_back(TagId{grid.first_id + i});
  const auto patterns = capture::tag_patterns(family, ids);
  if (!patterns) return console.fail(patterns.error());
  const auto document =
      recordings::lay_out_board(grid, *shape, *patterns, {paper_of(args), args.one_page});
  const Json more{{"board",
                   {{"type", "aprilgrid"},
                    {"family", family},
                    {"rows", grid.rows},
                    {"columns", grid.columns},
                    {"tag_size_m", grid.tag_size_m},
                    {"gap_m", grid.gap_m},
                    {"first_id", grid.first_id},
                    {"thickness_m", grid.thickness_m}}},
                  {"board_toml", recordings::board_table(grid, family)}};
  return write(args, document, more, console);
}

/// Returns the board described by the arguments.
CalibrationTarget board_of_arguments(const PrintArguments& args) {
  const auto with_squares = [&](auto board) {
    if (args.squares_x > 0) board.columns = args.squares_x;
    if (args.squares_y > 0) board.rows = args.squares_y;
    if (args.square_size_m > 0.0) board.square_size_m = args.square_size_m;
    board.thickness_m = args.thickness_m;
    return board;
  };
  if (args.type == "charuco") return with_squares(args.charuco);
  if (args.type == "chessboard") return with_squares(args.chessboard);
  AprilGrid grid = args.grid;
  grid.thickness_m = args.thickness_m;
  return grid;
}

}  // namespace

Exit run_tags(const PrintArguments& args, Console& console) {
  auto tags = args.session.empty() ? tags_of_arguments(args) : tags_of_session(args);
  if (!tags) return console.fail(tags.error());
  const auto document =
      recordings::lay_out_tags({*std::move(tags), paper_of(args), args.plates});
  return write(args, document, Json::object(), console);
}

Exit run_board(const PrintArguments& args, Console& console) {
  CalibrationTarget target = board_of_arguments(args);
  std::string family = args.family;
  if (!args.session.empty()) {
    const auto session = recordings::read_session(args.session);
    if (!session) return console.fail(session.error());
    target = session->target;
    if (const auto* grid = std::get_if<AprilGrid>(&target)) {
      family = session->family_of(TagId{grid->first_id});
    }
    if (std::holds_alternative<Wand>(target)) {
      return console.fail(
          bad_input(session->file.string(),
                    "its cameras are calibrated with a wand, not with a board",
                    "print the wand's tags with marey tags --ids and --size"));
    }
  }
  if (const auto* grid = std::get_if<AprilGrid>(&target)) {
    return print_board(args, *grid, family, console);
  }
  if (const auto* board = std::get_if<CharucoBoard>(&target)) {
    return print_board(args, *board, console);
  }
  return print_board(args, std::get<Chessboard>(target), console);
}

}  // namespace marey::app
