// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/jump/jump_commands.h"

#include <string>

#include <nlohmann/json.hpp>

#include "app/edit/edit_outputs.h"
#include "app/edit/edit_run.h"
#include "app/jump/jump_json.h"
#include "app/jump/jump_report.h"
#include "app/jump/jump_run.h"
#include "app/shell/findings.h"
#include "core/base/format_text.h"

namespace marey::app {

Exit run_jump(const JumpArguments& args, Console& console) {
  const auto format = check_jump_out(args);
  if (!format) return console.fail(format.error());
  const auto run = run_jump_edit(args, *format, console);
  if (!run) return console.fail(run.error());
  const Status written =
      write_result_motion(args.out, *format, run->state(), run->edit.files.look);
  if (!written) return console.fail(written.error());
  if (args.json) print_edit_json(jump_json(args, *run));
  print_warnings(console, run->findings);
  for (const std::string& line : jump_lines(run->report())) console.say(line);
  console.say(format_text("%s: %d frames, %.2f s",
                          args.out.string().c_str(),
                          run->figures.frames,
                          run->figures.duration_s));
  return print_failures(console, run->findings);
}

void add_jump_command(CLI::App& app,
                      JumpArguments& args,
                      std::function<Exit(Console&)>& chosen) {
  CLI::App* command =
      app.add_subcommand("jump", "Make a jump of a motion higher, longer or ballistic");
  add_jump_options(*command, args);
  command->callback(
      [&] { chosen = [&args](Console& console) { return run_jump(args, console); }; });
}

}  // namespace marey::app
