// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/shell/console.h"
#include "core/board.h"
#include "recordings/print/print_board.h"
#include "recordings/print/print_words.h"
#include "recordings/print/printed_page.h"

namespace marey::app {

/// What `marey tags` and `marey board` were asked for.
struct PrintArguments {
  std::filesystem::path out;
  std::filesystem::path session;  ///< Empty: none.
  bool json = false;
  recordings::Paper paper;
  double margin_m = 0.010;
  std::string family = "tag36h11";
  // marey tags
  std::vector<recordings::NamedTag> ids;
  double size_m = 0.0;  ///< 0: the session's.
  bool plates = false;
  // marey board
  std::string type = "aprilgrid";
  bool one_page = false;
  double thickness_m = 0.0;
  AprilGrid grid{6, 6, 0.022, 0.0066, 0, 0.0};
  CharucoBoard charuco{.rows = 7,
                       .columns = 5,
                       .square_size_m = 0.030,
                       .marker_size_m = 0.022,
                       .dictionary = "DICT_5X5_100"};
  Chessboard chessboard{.rows = 7, .columns = 10, .square_size_m = 0.025};
  // Of the latter two; 0: as above.
  int squares_x = 0;
  int squares_y = 0;
  double square_size_m = 0.0;
};

/// `marey tags`: a PDF of tags, true to scale.
[[nodiscard]] Exit run_tags(const PrintArguments& args, Console& console);

/// `marey board`: a PDF of a calibration board.
[[nodiscard]] Exit run_board(const PrintArguments& args, Console& console);

/// Adds both commands; the one that is given becomes `chosen`. Mistakes in single words,
/// such as a length without unit, are CLI11's to tell: exit 2.
void add_print_commands(CLI::App& app,
                        PrintArguments& args,
                        std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
