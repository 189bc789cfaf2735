// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/parts/result_table.h"

#include <algorithm>
#include <cstdio>
#include <fstream>

#include <nlohmann/json.hpp>

namespace marey {
namespace {

std::string text_of(const TableCell& cell, int decimals) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.*f", decimals, std::get<double>(cell));
  return buffer;
}

/// Words stand left, numbers right.
void print_cell(const std::string& text, std::size_t width, bool is_left) {
  std::printf(is_left ? "%-*s  " : "%*s  ", static_cast<int>(width), text.c_str());
}

}  // namespace

void print_table(const ResultTable& table) {
  std::vector<std::size_t> widths;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    widths.push_back(table.columns[c].name.size());
    for (const auto& row : table.rows) {
      widths[c] = std::max(widths[c], text_of(row[c], table.columns[c].decimals).size());
    }
  }
  std::printf("\n%s\n", table.title.c_str());
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    print_cell(table.columns[c].name, widths[c], c == 0);
  }
  std::printf("\n");
  for (const auto& row : table.rows) {
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      print_cell(text_of(row[c], table.columns[c].decimals), widths[c], c == 0);
    }
    std::printf("\n");
  }
  for (const std::string& note : table.notes) std::printf("  %s\n", note.c_str());
  std::fflush(stdout);
}

Status write_tables(const std::filesystem::path& path,
                    const std::vector<ResultTable>& tables) {
  nlohmann::json all = nlohmann::json::array();
  for (const ResultTable& table : tables) {
    nlohmann::json rows = nlohmann::json::array();
    for (const auto& row : table.rows) {
      nlohmann::json object = nlohmann::json::object();
      for (std::size_t c = 0; c < table.columns.size(); ++c) {
        std::visit([&](const auto& cell) { object[table.columns[c].name] = cell; },
                   row[c]);
      }
      rows.push_back(std::move(object));
    }
    all.push_back({{"id", table.id},
                   {"title", table.title},
                   {"notes", table.notes},
                   {"rows", std::move(rows)}});
  }
  std::ofstream file(path);
  file << all.dump(1) << '\n';
  file.close();
  if (!file) return bad_input(path.string(), "cannot be written", "choose another file");
  return Done{};
}

}  // namespace marey
