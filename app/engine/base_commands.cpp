// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/engine/base_commands.h"

#include <cstdio>
#include <string_view>
#include <system_error>
#include <utility>

#include "engine/clips/make_clip.h"
#include "engine/clips/motion_base.h"
#include <nlohmann/json.hpp>

#include "app/engine/base_json.h"
#include "app/engine/open_base.h"
#include "app/library/find/clip_table.h"
#include "app/shell/option_checks.h"
#include "core/base/format_text.h"
#include "core/base/in_quotes.h"
#include "recordings/moves/write_moves.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kBaseEnding = ".marey";

/// Checks the result's file before the work.
Status check_base_out(const BaseArguments& args) {
  if (args.out.extension() != kBaseEnding) {
    return bad_usage("--out",
                     in_quotes(args.out.string()) + " is no name of a base of clips",
                     "give one that ends with .marey");
  }
  if (const Status ok = check_out_file(args.out); !ok) return ok;
  std::error_code ignored;
  for (const fs::path& path : args.inputs.paths) {
    if (!fs::equivalent(path, args.out, ignored)) continue;
    return bad_input(
        args.out.string(), "it is one of the inputs", "give another file to --out");
  }
  return Done{};
}

void print_base(const engine::MotionBase& base, bool as_json) {
  if (as_json) {
    print_library_json(base_json(base));
  } else {
    std::fputs(base_table(base).c_str(), stdout);
  }
}

}  // namespace

Exit run_base_build(const BaseArguments& args, Console& console) {
  if (const Status ok = check_base_out(args); !ok) return console.fail(ok.error());
  const auto sources = read_base_sources(args.inputs, console);
  if (!sources) return console.fail(sources.error());
  const auto moves = engine::make_moves(*sources);
  if (!moves) return console.fail(moves.error());
  if (const Status ok = recordings::write_moves(args.out, *moves); !ok) {
    return console.fail(ok.error());
  }
  // The file is read again, as the engine reads it.
  const auto base = open_base(args.out);
  if (!base) return console.fail(base.error());
  print_base(**base, args.json);
  std::error_code ignored;
  console.say(format_text("%s: %zu clips, %.1f MB",
                          args.out.string().c_str(),
                          (*base)->clips().size(),
                          1e-6 * static_cast<double>(fs::file_size(args.out, ignored))));
  return Exit::kOk;
}

Exit run_base_list(const BaseArguments& args, Console& console) {
  const auto base = open_base(args.file);
  if (!base) return console.fail(base.error());
  print_base(**base, args.json);
  return Exit::kOk;
}

Exit run_base_check(const BaseArguments& args, Console& console) {
  const auto base = open_base(args.file);
  if (!base) return console.fail(base.error());
  console.say(format_text(
      "%s: %zu clips, no fault", args.file.string().c_str(), (*base)->clips().size()));
  return Exit::kOk;
}

namespace {

void add_base_build(CLI::App& base,
                    BaseArguments& args,
                    std::function<Exit(Console&)>& chosen) {
  CLI::App* command = base.add_subcommand(
      "build", "Make clips from motions, recipes or clips of a library");
  command
      ->add_option("PATH",
                   args.inputs.paths,
                   "Motion, recipe (.edit.toml), folder of them, or library")
      ->required();
  command->add_option(
      "--query",
      args.inputs.query,
      "Expression that selects clips of a library (docs/library_queries.md)");
  command
      ->add_option(
          "--loops",
          args.inputs.loops,
          "Name of a clip whose last frame equals its first one; may be repeated")
      ->allow_extra_args(false);
  command->add_option("-o,--out", args.out, "Result (.marey)")->required();
  command->add_flag("--json", args.json, "Prints JSON on standard output");
  command->callback([&] {
    chosen = [&args](Console& console) { return run_base_build(args, console); };
  });
}

}  // namespace

void add_base_command(CLI::App& app,
                      BaseArguments& args,
                      std::function<Exit(Console&)>& chosen) {
  CLI::App* base = app.add_subcommand("base", "Make, list or check clips for the engine");
  base->require_subcommand(1);
  add_base_build(*base, args, chosen);
  CLI::App* list = base->add_subcommand("list", "List the clips of a file");
  list->add_option("FILE", args.file, "Clips (.marey)")->required();
  list->add_flag("--json", args.json, "Prints JSON on standard output");
  list->callback([&] {
    chosen = [&args](Console& console) { return run_base_list(args, console); };
  });
  CLI::App* check = base->add_subcommand("check", "Check that a file is whole");
  check->add_option("FILE", args.file, "Clips (.marey)")->required();
  check->callback([&] {
    chosen = [&args](Console& console) { return run_base_check(args, console); };
  });
}

}  // namespace marey::app
