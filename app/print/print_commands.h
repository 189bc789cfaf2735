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

/// Arguments of `marey tags` and `marey board`.
struct PrintArguments {
  std::filesystem::path out;
  std::filesystem::path session;  ///< Empty: none.
  bool json = false;
  recordings::Paper paper;
  double margin_m = 0.010;
  std::string family = "tag36h11";
  // marey tags
  std::vector<recordings::NamedTag> ids;
  double size_m = 0.0;  ///< 0: sizes of the session.
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
  // For ChArUco and chessboard; 0: the default above.
  int squares_x = 0;
  int squares_y = 0;
  double square_size_m = 0.0;
};

/// Runs `marey tags`: writes a PDF of tags, true to scale.
[[nodiscard]] Exit run_tags(const PrintArguments& args, Console& console);

/// Runs `marey board`: writes a PDF of a calibration board, true to scale.
[[nodiscard]] Exit run_board(const PrintArguments& args, Console& console);

/// Adds both commands. Parsing one of them sets `chosen`. CLI11 reports invalid values,
/// such as a length without unit, with exit code 2.
void add_print_commands(CLI::App& app,
                        PrintArguments& args,
                        std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
