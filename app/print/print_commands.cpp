// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/print/print_commands.h"

#include <memory>
#include <utility>

#include "app/shell/option_checks.h"

namespace marey::app {
namespace {

/// Adds an option whose text is parsed into `value`.
template <class T, class Parse>
CLI::Option* add_parsed(CLI::App& command,
                        const std::string& name,
                        const std::string& help,
                        const std::string& type,
                        T& value,
                        Parse parse) {
  const auto take = [&value, parse, name](const CLI::results_t& words) {
    auto parsed = parse(words.front());
    if (!parsed) {
      throw RejectedArguments(name + ": " + parsed.error().cause, parsed.error().next);
    }
    value = *std::move(parsed);
    return true;
  };
  return command.add_option(name, take, help)->type_name(type);
}

CLI::Option* add_length(CLI::App& command,
                        const std::string& name,
                        const std::string& help,
                        double& length_m) {
  return add_parsed(command, name, help, "LENGTH", length_m, recordings::parse_length_m);
}

CLI::Option* add_margin(CLI::App& command, double& margin_m) {
  const auto parse = [](const std::string& text) -> Result<double> {
    constexpr double kMax_m = 0.1;
    auto parsed = recordings::parse_length_m(text);
    if (!parsed || *parsed <= kMax_m) return parsed;
    return bad_input("margin", "\"" + text + "\" is more than 100 mm", "use 10mm");
  };
  return add_parsed(command,
                    "--margin",
                    "White edge that printers cannot reach; default 10mm",
                    "LENGTH",
                    margin_m,
                    parse);
}

/// Adds the options of both commands.
void add_common(CLI::App& command, PrintArguments& args) {
  command.add_option("-o,--out", args.out, "Result (.pdf)")->required();
  add_parsed(command,
             "--page",
             "A4 (default), A3, Letter, or WIDTHxHEIGHT such as 210x297mm",
             "PAGE",
             args.paper,
             recordings::parse_paper);
  add_margin(command, args.margin_m);
  command.add_flag("--json", args.json, "Print the layout of the pages as JSON");
}

void add_tags(CLI::App& app,
              PrintArguments& args,
              std::function<Exit(Console&)>& chosen) {
  CLI::App* command = app.add_subcommand("tags", "Print tags, true to scale (PDF)");
  add_common(*command, args);
  CLI::Option* session =
      command->add_option("--session",
                          args.session,
                          "Print the body's tags of this session, each at its own size");
  CLI::Option* ids =
      add_parsed(*command,
                 "--ids",
                 "40-75,90 or with segments 41:hips,73:head; with --session, only "
                 "these of its tags",
                 "IDS",
                 args.ids,
                 recordings::parse_tags);
  CLI::Option* family = command->add_option("--family",
                                            args.family,
                                            "Family of the tags: tag36h11 (default), "
                                            "tag25h9, tagStandard41h12...");
  CLI::Option* size = add_length(
      *command, "--size", "Edge of a tag's square, with its unit: 80mm", args.size_m);
  family->excludes(session);
  size->excludes(session);
  command->add_flag(
      "--plates",
      args.plates,
      "Fold pairs of tags to plates for limbs, at 45 degrees to either side");
  command->callback([&, session, ids, size] {
    if (session->count() == 0 && (ids->count() == 0 || size->count() == 0)) {
      throw RejectedArguments("there is nothing to print",
                              "give --session, or --ids and --size");
    }
    chosen = [&args](Console& console) { return run_tags(args, console); };
  });
}

void add_aprilgrid(CLI::App& command,
                   PrintArguments& args,
                   std::vector<CLI::Option*>& own) {
  const auto count = whole_between(1, 50);
  AprilGrid& grid = args.grid;
  own = {
      command.add_option(
          "--family", args.family, "Family of the tags: tag36h11 (default)"),
      command.add_option("--columns", grid.columns, "Tags along x; default 6")
          ->check(count),
      command.add_option("--rows", grid.rows, "Tags along y; default 6")->check(count),
      add_length(
          command, "--tag-size", "Edge of a tag's square; default 22mm", grid.tag_size_m),
      add_length(
          command, "--gap", "Distance between two squares; default 6.6mm", grid.gap_m),
      command.add_option("--first-id", grid.first_id, "The tag at the origin; default 0")
          ->check(whole_between(0, 65535))};
  for (CLI::Option* option : own) option->group("AprilGrid");
}

void add_charuco(CLI::App& command,
                 PrintArguments& args,
                 std::vector<CLI::Option*>& own) {
  CharucoBoard& board = args.charuco;
  own = {add_length(command,
                    "--marker-size",
                    "Edge of a marker; default 22mm",
                    board.marker_size_m),
         command.add_option("--dictionary",
                            board.dictionary,
                            "OpenCV's name, such as DICT_5X5_100 (default) or "
                            "DICT_APRILTAG_36h11"),
         command.add_flag("--legacy",
                          board.is_legacy,
                          "Pattern of OpenCV before 4.6 for an even number of rows")};
  for (CLI::Option* option : own) option->group("ChArUco");
}

void add_squares(CLI::App& command,
                 PrintArguments& args,
                 std::vector<CLI::Option*>& own) {
  const auto count = whole_between(2, 50);
  own = {command
             .add_option("--squares-x",
                         args.squares_x,
                         "Squares in a row; default 5, of a chessboard 10")
             ->check(count),
         command.add_option("--squares-y", args.squares_y, "Rows of squares; default 7")
             ->check(count),
         add_length(command,
                    "--square-size",
                    "Edge of a square; default 30mm, of a chessboard 25mm",
                    args.square_size_m)};
  for (CLI::Option* option : own) option->group("ChArUco and chessboard");
}

void add_board(CLI::App& app,
               PrintArguments& args,
               std::function<Exit(Console&)>& chosen) {
  CLI::App* command =
      app.add_subcommand("board", "Print a calibration board, true to scale (PDF)");
  add_common(*command, args);
  CLI::Option* session =
      command->add_option("--session", args.session, "Print the board of this session");
  CLI::Option* type =
      command
          ->add_option("--type", args.type, "aprilgrid (default), charuco or chessboard")
          ->check(one_of({"aprilgrid", "charuco", "chessboard"}));
  type->excludes(session);
  command->add_flag(
      "--one-page", args.one_page, "Reject a board that is larger than the page");
  add_length(
      *command,
      "--thickness",
      "Thickness of the plate behind the board, for the printed part of session.toml",
      args.thickness_m)
      ->excludes(session);
  std::vector<CLI::Option*> of_grid;
  std::vector<CLI::Option*> of_charuco;
  std::vector<CLI::Option*> of_squares;
  add_aprilgrid(*command, args, of_grid);
  add_charuco(*command, args, of_charuco);
  add_squares(*command, args, of_squares);
  for (const auto& options : {of_grid, of_charuco, of_squares}) {
    for (CLI::Option* option : options) option->excludes(session);
  }
  command->callback([&, of_grid, of_charuco, of_squares] {
    const auto refuse = [&](const std::vector<CLI::Option*>& options) {
      for (CLI::Option* option : options) {
        if (option->count() == 0) continue;
        throw RejectedArguments(
            option->get_name() + " does not belong to --type " + args.type,
            "leave it out");
      }
    };
    if (args.type != "aprilgrid") refuse(of_grid);
    if (args.type != "charuco") refuse(of_charuco);
    if (args.type == "aprilgrid") refuse(of_squares);
    chosen = [&args](Console& console) { return run_board(args, console); };
  });
}

}  // namespace

void add_print_commands(CLI::App& app,
                        PrintArguments& args,
                        std::function<Exit(Console&)>& chosen) {
  add_tags(app, args, chosen);
  add_board(app, args, chosen);
}

}  // namespace marey::app
