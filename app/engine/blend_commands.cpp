// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/engine/blend_commands.h"

#include <string>
#include <utility>

#include "edit/state/edit_state.h"
#include <nlohmann/json.hpp>

#include "app/edit/edit_outputs.h"
#include "app/edit/edit_run.h"
#include "app/engine/blend_figures.h"
#include "app/engine/blend_json.h"
#include "app/engine/blend_play.h"
#include "app/motion/error_of_file.h"
#include "app/shell/option_checks.h"
#include "core/base/format_text.h"

namespace marey::app {

Exit run_blend(const BlendArguments& args, Console& console) {
  const auto format = check_blend_out(args);
  if (!format) return console.fail(format.error());
  const auto inputs = read_blend_inputs(args, *format, console);
  if (!inputs) return console.fail(inputs.error());
  auto played = play_blend(args, *inputs);
  if (!played) return console.fail(played.error());
  const BlendFigures figures = measure_blend(args, *inputs, *played);
  const auto state = edit::make_edit_state(played->motion);
  if (!state) return console.fail(of_file(args.out, state.error()));
  if (const Status ok = write_result_motion(args.out, *format, *state, inputs->look);
      !ok) {
    return console.fail(ok.error());
  }
  if (args.json) print_edit_json(blend_json(args, *inputs, *played, figures));
  for (const std::string& remark : figures.remarks) console.warn(remark);
  for (const std::string& line : blend_lines(args, *inputs, figures)) console.say(line);
  console.say(format_text("%s: %d frames, %.2f s",
                          args.out.string().c_str(),
                          state->frame_count(),
                          state->duration_s()));
  return Exit::kOk;
}

void add_blend_command(CLI::App& app,
                       BlendArguments& args,
                       std::function<Exit(Console&)>& chosen) {
  constexpr double kLongest_s = 1e4;
  CLI::App* command =
      app.add_subcommand("blend", "Play one transition between two motions");
  command->add_option("A", args.from, "Motion or recipe; with --base the name of a clip")
      ->required();
  command->add_option("B", args.to, "Motion or clip to which the engine switches")
      ->required();
  command->add_option("--at", args.at_s, "Time in A of the switch [s]")
      ->check(between(0.0, kLongest_s))
      ->required();
  command->add_option("-o,--out", args.out, "Result: " + motion_extensions())->required();
  command->add_option("--base", args.base, "Clips (.marey): A and B are names of clips");
  command->add_option("--on", args.avatar, "Body that plays; else that of A");
  command->add_option("--fade", args.fade_s, "Duration of the blend; default 0.3 [s]")
      ->check(between(0.0, 10.0));
  command->add_option("--kind", args.kind, "Kind of the transition; default auto")
      ->check(one_of(blend_kinds()));
  command
      ->add_option(
          "--seconds", args.seconds, "Duration of the result; else to the end of B [s]")
      ->check(between(0.0, kLongest_s));
  command->add_flag("--json", args.json, "Prints the figures as JSON on standard output");
  command->callback(
      [&] { chosen = [&args](Console& console) { return run_blend(args, console); }; });
}

}  // namespace marey::app
