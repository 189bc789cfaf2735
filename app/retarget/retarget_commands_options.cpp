// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/motion/motion_files.h"
#include "app/motion/neutral.h"
#include "app/motion/raw_body.h"
#include "app/motion/retarget_files.h"
#include "app/retarget/retarget_commands.h"
#include "app/shell/option_checks.h"

namespace marey::app {
namespace {

void add_result_options(CLI::App& command, RetargetArguments& args) {
  std::vector<std::string> formats;
  for (const MotionFormat format : motion_formats()) formats.emplace_back(name(format));
  command
      .add_option("--formats",
                  args.formats,
                  "File formats in the folder, separated by commas; default glb, bvh "
                  "and vrma, if the body can have them")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(one_of(formats));
  command.add_option("--bvh-dialect", args.bvh_dialect, "Program that reads the .bvh")
      ->check(one_of({"blender", "mobu", "maya", "unity"}));
  command
      .add_option_function<double>(
          "--rate",
          [&args](double hz) { args.options.rate_hz = hz; },
          "Frames per second of the result; default the motion's")
      ->check(between(0.1, 2000.0));
  command.add_option("--clip", args.clip, "Name of the animation in .glb and .vrma")
      ->check([](const std::string& clip) {
        try {
          (void)nlohmann::json(clip).dump();
          return std::string();
        } catch (const nlohmann::json::type_error&) {
          return std::string("is not UTF-8 text");
        }
      });
  command.add_option("--constraints-out",
                     args.constraints_out,
                     "File for foot supports and hand touches, as constraints for marey "
                     "adapt (.xml)");
  command.add_flag("--report", args.report, "Also write a page of figures and pictures");
  command.add_flag("--json", args.json, "Print the figures as JSON on standard output");
}

void add_body_options(CLI::App& command, RetargetArguments& args) {
  using Root = retarget::RootNormalization;
  const std::map<std::string, Root> roots{{"leg-length", Root::kLegLength},
                                          {"arm-length", Root::kArmLength},
                                          {"none", Root::kNone}};
  command.add_option("--bones", args.bones, "Bone map of the avatar (TOML)");
  command.add_option("--motion-bones", args.motion_bones, "Bone map of the motion");
  command.add_option("--neutral", args.neutral, kNeutralHelp)->check(neutral_mistake);
  command
      .add_option_function<std::string>(
          "--root",
          [&args, roots](const std::string& word) {
            args.options.retarget.root = roots.at(word);
          },
          "Length that scales the path of the root; default leg-length")
      ->check(one_of_keys(roots))
      ->type_name("WORD");
  using Lengths = retarget::WorldLengths;
  const std::map<std::string, Lengths> lengths{{"scaled", Lengths::kScaled},
                                               {"kept", Lengths::kKept}};
  const auto add_lengths = [&](const char* option, Lengths& into, const char* help) {
    command
        .add_option_function<std::string>(
            option,
            [&into, lengths](const std::string& word) { into = lengths.at(word); },
            help)
        ->check(one_of_keys(lengths))
        ->type_name("WORD");
  };
  add_lengths("--path",
              args.options.retarget.path,
              "Path over the ground: scaled with the body, or kept in metres; default "
              "scaled");
  add_lengths("--heights",
              args.options.retarget.heights,
              "Heights of hands, feet and jumps: scaled or kept; default scaled");
  command.add_flag("--balance",
                   args.balance,
                   "Keep the centre of mass over the feet where the source does");
  command.add_flag("--no-ground", args.no_ground, "Do not keep feet on the floor");
  command.add_flag("--no-hands",
                   args.no_hands,
                   "Keep neither contacts of hands with the body, nor arms out of it");
  command.add_flag(
      "--live", args.options.live, "Retarget frame by frame, without future frames");
}

}  // namespace

void add_retarget_command(CLI::App& app,
                          RetargetArguments& args,
                          std::function<Exit(Console&)>& chosen) {
  CLI::App* command = app.add_subcommand("retarget", "Put a motion on other bodies");
  command->add_option("MOTION", args.motion, "Motion: " + body_extensions())->required();
  command->add_option(
      "AVATAR", args.avatars, "Bodies, one or many: " + body_extensions());
  command->add_option("-a,--avatar", args.more_avatars, "A body; may be repeated")
      ->allow_extra_args(false);
  command
      ->add_option("-o,--out",
                   args.out,
                   "Result: a folder, or for one avatar a file: " + motion_extensions())
      ->required();
  add_body_options(*command, args);
  add_result_options(*command, args);
  command->callback([&] {
    if (args.avatars.empty() && args.more_avatars.empty()) {
      throw RejectedArguments("AVATAR is missing",
                              "give a body: " + body_extensions() +
                                  "; marey retarget --help describes the arguments");
    }
    args.options.retarget.adapt_ground = !args.no_ground;
    if (!args.no_hands) args.options.retarget.hands.emplace();
    if (args.balance) args.options.retarget.balance.emplace();
    chosen = [&args](Console& console) { return run_retarget(args, console); };
  });
}

}  // namespace marey::app
