// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/library/export/export_options.h"
#include "app/library/export/export_report.h"
#include "app/shell/console.h"
#include "app/shell/exit_codes.h"
#include "core/base/result.h"
#include "core/library/library_settings.h"

namespace marey::app {

/// Arguments of `marey library export`.
struct LibraryExportArguments {
  std::filesystem::path library;
  std::filesystem::path out;
  std::string format;
  std::string query;
  std::string skeleton;                          ///< Empty: the default.
  std::optional<double> rate_hz = std::nullopt;  ///< nullopt: library.toml's.
  bool mirror = false;
  bool start_at_origin = false;
  std::string split;  ///< Empty: library.toml's.
  std::string split_by = "subject";
  std::vector<std::string> allowed_licences;  ///< Each may be a list with commas.
  bool licence_unknown = false;
  bool replace = false;
  bool json = false;
};

/// Returns the settings of an export, with the defaults of library.toml. Errors:
/// parse_split()'s.
[[nodiscard]] Result<ExportOptions> resolve_export(const LibraryExportArguments& args,
                                                   const LibrarySettings& settings);

/// Prints the results of an export: one line per fact, or one JSON object on standard
/// output. Returns exit code 4 if clips were left out.
Exit print_export(const ExportReport& report,
                  const ExportOptions& options,
                  bool as_json,
                  Console& console);

/// Exports clips of a library. Exit code 4 if selected clips were left out.
Exit run_library_export(const LibraryExportArguments& args, Console& console);

/// Adds the command `library export`.
void add_library_export_command(CLI::App& library,
                                LibraryExportArguments& args,
                                std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
