// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <exception>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/adapt/adapt_commands.h"
#include "app/convert/convert_commands.h"
#include "app/convert/mannequin_commands.h"
#include "app/edit/edit_commands.h"
#include "app/engine/base_commands.h"
#include "app/engine/blend_commands.h"
#include "app/inspect/doctor_commands.h"
#include "app/inspect/inspect_commands.h"
#include "app/jump/jump_commands.h"
#include "app/library/library_commands.h"
#include "app/library/page/library_view.h"
#include "app/live/listen_commands.h"
#include "app/live/live_commands.h"
#include "app/live/replay_commands.h"
#include "app/markers/fit_commands.h"
#include "app/markers/repair_commands.h"
#include "app/plan/plan_commands.h"
#include "app/print/print_commands.h"
#include "app/process/process_commands.h"
#include "app/record/record_commands.h"
#include "app/retarget/retarget_commands.h"
#include "app/shell/console.h"
#include "app/shell/exit_codes.h"
#include "app/shell/option_checks.h"
#include "app/shell/program_name.h"
#include "app/shell/sample_session.h"
#include "app/shell/stop_signal.h"
#include "app/shell/usage_error.h"
#include "app/stage/stage_commands.h"
#include "app/shell/version.h"
#include "app/view/view_commands.h"
#include "core/base/printable.h"

namespace marey::app {
namespace {

struct Arguments {
  std::string progress = "auto";
  SessionArguments session;
  RecordArguments record;
  LiveArguments live;
  ReplayArguments replay;
  ListenArguments listen;
  RetargetArguments retarget;
  AdaptArguments adapt;
  EditArguments edit;
  JumpArguments jump;
  LibraryArguments library;
  BaseArguments base;
  BlendArguments blend;
  StageArguments stage;
  ConvertArguments convert;
  MannequinArguments mannequin;
  PrintArguments print;
  PlanArguments plan;
  RepairArguments repair;
  FitArguments fit;
  ViewArguments view;
  InspectArguments inspect;
  DoctorArguments doctor;
  DemoArguments demo{.sample = sample_session(), .out = {}};

  [[nodiscard]] ProgressStyle style_of_progress() const {
    if (progress == "json") return ProgressStyle::kJson;
    return progress == "none" ? ProgressStyle::kQuiet : ProgressStyle::kAuto;
  }
};

ProgramName name_of(const CLI::App& app, const char* called) {
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands({})) {
    commands.push_back(command->get_name());
  }
  commands.emplace_back("--help");
  return {called == nullptr ? "" : called, std::move(commands)};
}

/// Returns true if the words ask for JSON, also when the rest of the line is wrong.
bool has_json_progress(std::span<char* const> words) {
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::string_view word = words[i];
    if (word == "--progress=json") return true;
    if (word == "--progress" && i + 1 < words.size() &&
        std::string_view(words[i + 1]) == "json") {
      return true;
    }
  }
  return false;
}

int run(int argc, char** argv) {
  CLI::App app{"marey turns camera-seen markers into clean human motion on any body"};
  app.formatter(std::make_shared<PlainHelp>());
  app.set_version_flag("--version", std::string("marey ") + kVersion);
  app.require_subcommand(1);
  app.fallthrough();
  Arguments args;
  std::function<Exit(Console&)> chosen;
  app.add_option("--progress", args.progress, "auto, json or none")
      ->check(one_of({"auto", "json", "none"}));
  add_session_commands(app, args.session, chosen);
  add_record_command(app, args.record, chosen);
  add_live_command(app, args.live, chosen);
  add_replay_command(app, args.replay, chosen);
  add_listen_command(app, args.listen, chosen);
  add_retarget_command(app, args.retarget, chosen);
  add_adapt_command(app, args.adapt, chosen);
  add_edit_command(app, args.edit, chosen);
  add_jump_command(app, args.jump, chosen);
  add_library_command(app, args.library, chosen);
  add_base_command(app, args.base, chosen);
  add_blend_command(app, args.blend, chosen);
  add_stage_command(app, args.stage, chosen);
  add_convert_command(app, args.convert, chosen);
  add_mannequin_command(app, args.mannequin, chosen);
  add_print_commands(app, args.print, chosen);
  add_plan_command(app, args.plan, chosen);
  add_repair_command(app, args.repair, chosen);
  add_fit_command(app, args.fit, chosen);
  add_view_command(app, args.view, library_folder_view(), chosen);
  add_inspect_command(app, args.inspect, chosen);
  add_doctor_command(app, args.doctor, chosen);
  add_demo_command(app, args.demo, chosen);
  refuse_absurd_numbers(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    const std::span<char* const> words(argv, static_cast<std::size_t>(argc));
    const ProgressStyle style =
        has_json_progress(words) ? ProgressStyle::kJson : ProgressStyle::kAuto;
    return static_cast<int>(Console(style, name_of(app, argv[0]))
                                .fail(usage_error(app, error, {argv, words.size()})));
  }
  Console console(args.style_of_progress(), name_of(app, argv[0]));
  const Exit exit = chosen(console);
  const bool is_written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (is_written || exit != Exit::kOk) return static_cast<int>(exit);
  return static_cast<int>(console.fail({Errc::kDevice,
                                        "standard output",
                                        "the output cannot be written",
                                        "free some disk space, or let the program that "
                                        "reads it run to its end"}));
}

}  // namespace
}  // namespace marey::app

int main(int argc, char** argv) {
  marey::app::exit_on_stop_signals();
  try {
    return marey::app::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr,
                 "error: internal: %s. Next: report this with the command that you "
                 "ran.\n",
                 marey::printable(error.what()).c_str());
    return static_cast<int>(marey::app::Exit::kInternal);
  }
}
