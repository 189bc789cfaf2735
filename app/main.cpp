// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <cstdio>
#include <exception>
#include <functional>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include "app/adapt_commands.h"
#include "app/commands.h"
#include "app/fit_commands.h"
#include "app/listen_commands.h"
#include "app/live_commands.h"
#include "app/neutral.h"
#include "app/option_checks.h"
#include "app/plan_commands.h"
#include "app/print_commands.h"
#include "app/repair_commands.h"
#include "app/retarget_commands.h"
#include "app/version.h"
#include "app/view_commands.h"
#include "recordings/atomic_file.h"

namespace marey::app {
namespace {

/// Files appear whole or not at all, so there is nothing to clean but those half written.
extern "C" void on_interrupt(int /*signal*/) {
  static constexpr char kText[] = "\ninterrupted\n";
  [[maybe_unused]] const ssize_t written =
      write(STDERR_FILENO, static_cast<const char*>(kText), sizeof kText - 1);
  recordings::visit_partial_files([](const char* path) { unlink(path); });
  _exit(static_cast<int>(Exit::kInterrupted));
}

struct Arguments {
  PipelineOptions pipeline;
  std::filesystem::path media;
  bool json = false;
  std::string progress = "auto";
  std::filesystem::path out;
  std::filesystem::path file;
  InspectBodyOptions inspect_body;
  std::filesystem::path sample = MAREY_SAMPLE;
  RecordArguments record;
  ConvertArguments convert;
  recordings::MannequinOptions mannequin;
  recordings::MannequinStyle style;
  PrintArguments print;
  PlanArguments plan;
  RepairArguments repair;
  FitArguments fit;
  AdaptArguments adapt;
  RetargetArguments retarget;
  LiveArguments live;
  ListenArguments listen;
  ReplayArguments replay;
  ViewArguments view;

  [[nodiscard]] ProgressStyle style_of_progress() const {
    if (progress == "json") return ProgressStyle::kJson;
    return progress == "none" ? ProgressStyle::kQuiet : ProgressStyle::kAuto;
  }
};

using Command = std::function<Exit(Console&)>;

void add_session_command(CLI::App& app,
                         const char* name,
                         const char* help,
                         Stage stage,
                         Arguments& args,
                         Command& chosen) {
  CLI::App* command = app.add_subcommand(name, help);
  command->add_option("session", args.pipeline.session, "session.toml, or its folder")
      ->required();
  command->add_option("-o,--out", args.pipeline.out, "Folder for the results")
      ->required();
  command->add_option(
      "--media", args.media, "Folder that the session's video paths are relative to");
  if (stage == Stage::kSolve || stage == Stage::kProcess) {
    command
        ->add_option("-a,--avatar",
                     args.pipeline.avatars,
                     "Body to put the motion on (.glb, .vrm, .bvh); may be repeated")
        // One each time: what follows may be the session.
        ->allow_extra_args(false);
  }
  if (stage == Stage::kCalibrate || stage == Stage::kProcess) {
    std::vector<std::string> lenses;
    for (const auto& [word, lens] : recordings::kLensWords) lenses.emplace_back(word);
    command
        ->add_option("--lens",
                     args.pipeline.lens,
                     "Lens of the cameras, instead of the session's: auto, "
                     "brown-conrady, rational or fisheye")
        ->check(CLI::IsMember(lenses));
  }
  command->add_flag("--json", args.json, "Print the figures as JSON on standard output");
  command->callback([&, stage] {
    if (!args.media.empty()) args.pipeline.media = args.media;
    chosen = [&args, stage](Console& console) {
      return run_session(stage, args.pipeline, args.json, console);
    };
  });
}

void add_record(CLI::App& app, Arguments& args, Command& chosen) {
  CLI::App* command = app.add_subcommand("record", "Record a trial from the cameras");
  command->add_option("session", args.record.session, "session.toml, or its folder")
      ->required();
  command->add_option("-o,--out", args.record.out, "Folder of the take")->required();
  command->add_option("--trial", args.record.trial, "The session's trial to record")
      ->required();
  command->add_option("--seconds", args.record.seconds, "Stop by itself after so long")
      ->check(between(0.001, 1e6));
  command->callback([&] {
    chosen = [&args](Console& console) { return run_record(args.record, console); };
  });
}

void add_mannequin(CLI::App& app, Arguments& args, Command& chosen) {
  CLI::App* command =
      app.add_subcommand("mannequin", "Make a skinned body of any proportions (GLB)");
  recordings::MannequinOptions& m = args.mannequin;
  const auto size = between(0.3, 10.0);
  const auto ratio = between(0.2, 5.0);
  command->add_option("--height", m.stature_m, "Stature [m]")->check(size);
  command->add_option("--arm-ratio", m.arm, "Arms against the average")->check(ratio);
  command->add_option("--leg-ratio", m.leg, "Legs")->check(ratio);
  command->add_option("--foot-ratio", m.foot, "Feet")->check(ratio);
  command->add_option("--trunk-ratio", m.trunk, "Trunk")->check(ratio);
  command->add_option("--head-ratio", m.head, "Neck and head")->check(ratio);
  command->add_option("--shoulder-ratio", m.shoulder_width, "Shoulder breadth")
      ->check(ratio);
  command->add_option("--hip-ratio", m.hip_width, "Hip breadth")->check(ratio);
  command->add_option("--girth", args.style.girth, "Thickness of every part")
      ->check(ratio);
  command->add_option("-o,--out", args.out, "Result (.glb)")->required();
  command->callback([&] {
    chosen = [&args](Console& console) {
      return run_mannequin(args.mannequin, args.style, args.out, console);
    };
  });
}

void add_convert(CLI::App& app, Arguments& args, Command& chosen) {
  CLI::App* command =
      app.add_subcommand("convert", "Markers or a motion as another kind of file");
  ConvertArguments& c = args.convert;
  const CLI::IsMember axis({"+X", "+Y", "+Z", "-X", "-Y", "-Z"});
  const CLI::IsMember unit({"mm", "cm", "m", "in", "ft"});
  command->add_option("in", c.in, ".c3d or .trc; .bvh, .amc, .npz, .glb, .vrm or .vrma")
      ->required();
  command
      ->add_option("out",
                   c.out,
                   "Result, of markers .c3d or .trc, of a motion .bvh, .vrma, .npz, .csv "
                   "or .mot")
      ->required();
  command->add_option("--up", c.up, "Axis of IN that is up, if not as found")
      ->check(axis);
  command->add_option("--unit", c.unit, "Unit of IN, if not as it says")->check(unit);
  command->add_option("--to-up", c.to_up, "Axis of OUT that is up")->check(axis);
  command->add_option("--to-unit", c.to_unit, "Unit of OUT")->check(unit);
  command->add_option("--skeleton", c.skeleton, "The .asf of an .amc, if not beside it");
  command->add_option("--rate", c.rate_hz, "Frames per second of IN, if not as it says")
      ->check(between(0.1, 2000.0));
  command->add_option("--to-rate", c.to_rate_hz, "Frames per second of OUT")
      ->check(between(0.1, 2000.0));
  command->add_option("--bvh-dialect", c.bvh_dialect, "For whom a .bvh is")
      ->check(CLI::IsMember({"blender", "mobu", "maya", "unity"}));
  command->add_option("--neutral", c.neutral, kNeutralHelp)->check(neutral_mistake);
  command->add_flag("--json", args.json, "Print the figures as JSON on standard output");
  command->callback([&] {
    chosen = [&args](Console& console) {
      return run_convert(args.convert, args.json, console);
    };
  });
}

void add_small_commands(CLI::App& app, Arguments& args, Command& chosen) {
  CLI::App* inspect = app.add_subcommand("inspect", "Say what a file holds");
  inspect->add_option("file", args.file, "A session, result, motion or body")->required();
  inspect->add_flag("--json", args.json, "As JSON");
  inspect->add_option(
      "--bones", args.inspect_body.bone_map, "Bone map of the body (TOML)");
  inspect->add_flag(
      "--write-map", args.inspect_body.write_map, "Store the bone map beside the body");
  inspect->add_option("--neutral", args.inspect_body.neutral, kNeutralHelp)
      ->check(neutral_mistake);
  inspect->add_option(
      "--picture", args.inspect_body.picture, "Draw the body's bones: .svg or .png");
  inspect->callback([&] {
    chosen = [&args](Console& console) {
      return run_inspect(args.file, args.inspect_body, args.json, console);
    };
  });
  CLI::App* doctor = app.add_subcommand("doctor", "Check this machine");
  doctor->add_flag("--json", args.json, "As JSON");
  doctor->callback([&] {
    chosen = [&args](Console& console) { return run_doctor(args.json, console); };
  });
  CLI::App* demo = app.add_subcommand("demo", "Process the sample session on two bodies");
  demo->add_option("-o,--out", args.out, "Folder for the results")
      ->default_val("out/first-light");
  demo->add_option("--sample", args.sample, "Folder of the sample session");
  demo->callback([&] {
    chosen = [&args](Console& console) {
      return run_demo(args.sample, args.out, console);
    };
  });
}

int run(int argc, char** argv) {
  CLI::App app{"marey turns camera-seen markers into clean human motion on any body"};
  app.set_version_flag("--version", std::string("marey ") + kVersion);
  app.require_subcommand(1);
  app.fallthrough();
  Arguments args;
  Command chosen;
  app.add_option("--progress", args.progress, "auto, json or none")
      ->check(CLI::IsMember({"auto", "json", "none"}));
  add_session_command(app,
                      "process",
                      "Everything: tags, cameras, subject, motion, avatars, report",
                      Stage::kProcess,
                      args,
                      chosen);
  add_session_command(
      app, "track", "Find the tags of every trial", Stage::kTrack, args, chosen);
  add_session_command(
      app, "calibrate", "Calibrate the cameras", Stage::kCalibrate, args, chosen);
  add_session_command(app,
                      "solve",
                      "Subject, motion and avatars, with the cameras calibrated before",
                      Stage::kSolve,
                      args,
                      chosen);
  add_record(app, args, chosen);
  add_live_commands(app, args.live, args.replay, chosen);
  add_listen_command(app, args.listen, chosen);
  add_retarget_command(app, args.retarget, chosen);
  add_adapt_command(app, args.adapt, chosen);
  add_convert(app, args, chosen);
  add_mannequin(app, args, chosen);
  add_print_commands(app, args.print, chosen);
  add_plan_command(app, args.plan, chosen);
  add_repair_command(app, args.repair, chosen);
  add_fit_command(app, args.fit, chosen);
  add_view_command(app, args.view, chosen);
  add_small_commands(app, args, chosen);
  refuse_absurd_numbers(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(Exit::kUsage);
  }
  Console console(args.style_of_progress());
  const Exit exit = chosen(console);
  const bool told = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (told || exit != Exit::kOk) return static_cast<int>(exit);
  return static_cast<int>(console.fail({Errc::kDevice,
                                        "standard output",
                                        "what was asked for cannot be written",
                                        "free some disk space, or read on in the other "
                                        "program"}));
}

}  // namespace
}  // namespace marey::app

int main(int argc, char** argv) {
  std::signal(SIGINT, marey::app::on_interrupt);
  std::signal(SIGTERM, marey::app::on_interrupt);
  // Under nohup(1) the terminal's end is none of our business.
  if (std::signal(SIGHUP, marey::app::on_interrupt) == SIG_IGN) {
    std::signal(SIGHUP, SIG_IGN);
  }
  try {
    return marey::app::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr,
                 "error: internal: %s. Next: report this with the command that you "
                 "ran.\n",
                 error.what());
    return static_cast<int>(marey::app::Exit::kInternal);
  }
}
