// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "core/base/result.h"

namespace marey {

/// Format of a column's numbers: "us" with two decimals.
struct TableColumn {
  std::string name;
  int decimals = 2;
};

using TableCell = std::variant<std::string, double>;

/// Result of a benchmark, for people and for programs.
struct ResultTable {
  std::string id;     ///< "near_com": the same from run to run.
  std::string title;  ///< One line.
  std::vector<TableColumn> columns;
  std::vector<std::vector<TableCell>> rows;  ///< As many cells as columns.
  std::vector<std::string> notes;            ///< Printed below.
};

/// Prints the table to the standard output, with aligned columns.
void print_table(const ResultTable& table);

/// Writes the numbers unrounded. Errors: the file cannot be written.
[[nodiscard]] Status write_tables(const std::filesystem::path& path,
                                  const std::vector<ResultTable>& tables);

}  // namespace marey
