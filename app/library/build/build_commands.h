// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

#include <CLI/CLI.hpp>

#include "app/library/sources/add_sources.h"
#include "app/shell/console.h"
#include "app/shell/exit_codes.h"

namespace marey::app {

/// Arguments of `marey library build`, `add`, `plan`, `work` and `merge`.
struct LibraryBuildArguments {
  std::filesystem::path library;
  int jobs = 0;    ///< Processes; 0: one per core.
  int shards = 0;  ///< Number of shards of a plan.
  int shard = 0;   ///< To work on, from 1.
  bool slurm = false;
  bool json = false;
  AddSourcesArguments added;  ///< Arguments of `add`, without its library.
};

/// Brings a library up to date. Exit code 4 if a source gave nothing.
Exit run_library_build(const LibraryBuildArguments& args, Console& console);

/// Names sources in library.toml, which is created if it does not exist, then builds.
Exit run_library_add(const LibraryBuildArguments& args, Console& console);

/// Divides the sources into shards; with `slurm`, prints a script that runs them.
Exit run_library_plan(const LibraryBuildArguments& args, Console& console);

/// Makes the objects of one shard. May run on any host that sees the library's folder,
/// together with others. Repeated, it does nothing.
Exit run_library_work(const LibraryBuildArguments& args, Console& console);

/// Makes index, rows and version of the finished shards. Exit code 4 as
/// run_library_build().
Exit run_library_merge(const LibraryBuildArguments& args, Console& console);

/// Adds these commands to `marey library`.
void add_library_build_commands(CLI::App& library,
                                LibraryBuildArguments& args,
                                std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
