// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/convert/mannequin_commands.h"

#include "app/shell/option_checks.h"
#include "core/base/extension.h"
#include "recordings/gltf/gltf.h"

namespace marey::app {

Exit run_mannequin(const recordings::MannequinOptions& options,
                   const recordings::MannequinStyle& style,
                   const std::filesystem::path& out,
                   Console& console) {
  if (kind_by_extension(out) != ".glb") {
    return console.fail(bad_input(
        out.string(), "a mannequin can only be written as GLB", "name the result .glb"));
  }
  if (const Status ok = check_out_file(out); !ok) return console.fail(ok.error());
  const Proportions proportions = recordings::mannequin_proportions(options);
  const Status ok =
      recordings::write_character(out,
                                  make_humanoid(proportions),
                                  recordings::make_mannequin_mesh(proportions, style));
  if (!ok) return console.fail(ok.error());
  console.say("mannequin: " + out.string());
  return Exit::kOk;
}

void add_mannequin_command(CLI::App& app,
                           MannequinArguments& args,
                           std::function<Exit(Console&)>& chosen) {
  CLI::App* command =
      app.add_subcommand("mannequin", "Make a skinned body of any proportions (GLB)");
  recordings::MannequinOptions& m = args.options;
  const auto size = between(0.3, 10.0);
  const auto ratio = between(0.2, 5.0);
  command->add_option("--height", m.stature_m, "Stature [m]")->check(size);
  command->add_option("--arm-ratio", m.arm, "Length of the arms relative to the average")
      ->check(ratio);
  command->add_option("--leg-ratio", m.leg, "Length of the legs relative to the average")
      ->check(ratio);
  command
      ->add_option("--foot-ratio", m.foot, "Length of the feet relative to the average")
      ->check(ratio);
  command
      ->add_option(
          "--trunk-ratio", m.trunk, "Length of the trunk relative to the average")
      ->check(ratio);
  command
      ->add_option(
          "--head-ratio", m.head, "Size of neck and head relative to the average")
      ->check(ratio);
  command
      ->add_option("--shoulder-ratio",
                   m.shoulder_width,
                   "Shoulder breadth relative to the average")
      ->check(ratio);
  command->add_option("--hip-ratio", m.hip_width, "Hip breadth relative to the average")
      ->check(ratio);
  command
      ->add_option(
          "--girth", args.style.girth, "Thickness of all parts relative to the average")
      ->check(ratio);
  command->add_option("-o,--out", args.out, "Result (.glb)")->required();
  command->callback([&] {
    chosen = [&args](Console& console) {
      return run_mannequin(args.options, args.style, args.out, console);
    };
  });
}

}  // namespace marey::app
