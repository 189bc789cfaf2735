// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/convert/convert_commands.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "app/convert/convert_motion.h"
#include "app/motion/neutral.h"
#include "app/motion/raw_body.h"
#include "app/shell/option_checks.h"
#include "core/base/extension.h"
#include "recordings/markers/marker_file.h"

namespace marey::app {
namespace {

/// Returns the unit and axes of the output: those of the options, else of the source. A
/// TRC cannot state its up axis, and its readers expect +Y.
recordings::FileAxes target_axes(const ConvertArguments& arguments,
                                 const recordings::FileAxes& source) {
  recordings::FileAxes axes = source;
  if (kind_by_extension(arguments.out) == ".trc") axes.up = recordings::FileAxis::kPlusY;
  if (!arguments.to_up.empty()) {
    axes.up = recordings::axis_of(arguments.to_up).value_or(axes.up);
  }
  if (!arguments.to_unit.empty()) {
    axes.unit = arguments.to_unit;
    axes.per_metre =
        recordings::units_per_metre(arguments.to_unit).value_or(axes.per_metre);
  }
  return axes;
}

/// Returns an error for results of marey that cannot be converted, with the alternative.
std::optional<Error> no_conversion(const std::filesystem::path& in) {
  std::error_code ignored;
  const std::string kind = kind_by_extension(in);
  if (std::filesystem::is_directory(in, ignored)) {
    return bad_input(in.string(),
                     "a folder is not converted",
                     "name a file in it: TRIAL/motion.npz, motion.bvh, motion.glb or "
                     "markers.c3d; marey inspect lists the content of a folder");
  }
  if (kind == ".mot" || kind == ".sto") {
    return bad_input(in.string(),
                     "joint angles contain no segment lengths, which a motion needs",
                     "convert the motion.npz, .bvh or .glb that they were written with");
  }
  if (kind == ".sqlite") {
    return bad_input(in.string(),
                     "a take holds what cameras saw, not a motion",
                     "process the session of a recorded take (marey process), or play a "
                     "live take (marey replay)");
  }
  if (kind == ".csv" || kind == ".json" || kind == ".toml") {
    return bad_input(
        in.string(),
        "tables and settings are not converted",
        "convert the motion.npz, motion.bvh or markers.c3d of the same trial");
  }
  return std::nullopt;
}

}  // namespace

Exit run_convert(const ConvertArguments& arguments, Console& console) {
  std::error_code ignored;
  if (std::filesystem::equivalent(arguments.in, arguments.out, ignored)) {
    return console.fail(bad_input(arguments.out.string(),
                                  "input and output are the same file",
                                  "give the result another name"));
  }
  if (const auto error = no_conversion(arguments.in)) return console.fail(*error);
  if (const Status ok = check_out_file(arguments.out); !ok) {
    return console.fail(ok.error());
  }
  if (is_body_file(arguments.in)) return convert_motion(arguments, console);
  if (!recordings::check_marker_extension(arguments.in)) {
    return console.fail(bad_input(
        arguments.in.string(),
        "marey does not convert files of this kind",
        "give labelled markers (.c3d or .trc), or a motion (" + body_extensions() + ")"));
  }
  if (arguments.rate_hz || arguments.to_rate_hz || !arguments.skeleton.empty() ||
      !arguments.bvh_dialect.empty() || !arguments.neutral.empty()) {
    return console.fail(
        bad_input(arguments.in.string(),
                  "--rate, --to-rate, --skeleton, --neutral and --bvh-dialect are for "
                  "motions alone",
                  "leave them out, or give a motion: " + body_extensions()));
  }
  recordings::MarkerReadOptions read_as;
  if (!arguments.up.empty()) read_as.up = recordings::axis_of(arguments.up);
  if (!arguments.unit.empty()) read_as.unit = arguments.unit;
  const auto markers = recordings::read_markers(arguments.in, read_as);
  if (!markers) return console.fail(markers.error());
  for (const std::string& note : markers->notes) {
    console.warn(arguments.in.string() + ": " + note);
  }
  recordings::MarkerWriteOptions options;
  options.axes = target_axes(arguments, markers->axes);
  const bool same_axes = options.axes->up == markers->axes.up &&
                         options.axes->per_metre == markers->axes.per_metre;
  const bool both_c3d = kind_by_extension(arguments.in) == ".c3d" &&
                        kind_by_extension(arguments.out) == ".c3d";
  // Other data of a C3D is in the axes stated in the file, and is copied with that
  // statement. If the user corrected the axes, the copy would still state the old ones.
  const auto as_said = [](recordings::Evidence who) {
    return who == recordings::Evidence::kFile || who == recordings::Evidence::kConvention;
  };
  const bool copy =
      same_axes && as_said(markers->axes.up_from) && as_said(markers->axes.unit_from);
  if (both_c3d && copy) options.source = arguments.in;
  if (both_c3d && !copy) {
    console.warn(arguments.out.string() +
                 ": axes or units differ from those in the input file; only markers and "
                 "events are written, not analog channels and force plates");
  }
  const Status written = recordings::write_markers(arguments.out, *markers, options);
  if (!written) return console.fail(written.error());
  const MarkerTracks& tracks = markers->tracks;
  if (arguments.json) {
    const nlohmann::ordered_json figures{{"out", arguments.out.string()},
                                         {"markers", tracks.markers()},
                                         {"frames", tracks.frames()},
                                         {"rate_hz", tracks.rate.hz},
                                         {"unit", options.axes->unit},
                                         {"up", recordings::name(options.axes->up)},
                                         {"notes", markers->notes}};
    std::printf(
        "%s\n",
        figures.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace)
            .c_str());
  }
  console.say(arguments.out.string() + ": " + std::to_string(tracks.markers()) +
              " markers, " + std::to_string(tracks.frames()) + " frames, " +
              options.axes->unit + ", " +
              std::string(recordings::name(options.axes->up)) + " up");
  return Exit::kOk;
}

void add_convert_command(CLI::App& app,
                         ConvertArguments& args,
                         std::function<Exit(Console&)>& chosen) {
  CLI::App* command =
      app.add_subcommand("convert", "Convert markers or a motion to another format");
  const CLI::Validator axis = one_of({"+X", "+Y", "+Z", "-X", "-Y", "-Z"});
  const CLI::Validator unit = one_of({"mm", "cm", "m", "in", "ft"});
  command
      ->add_option(
          "INPUT", args.in, "Markers: .c3d or .trc; motion: " + body_extensions())
      ->required();
  command
      ->add_option("OUTPUT",
                   args.out,
                   "Result; markers: .c3d or .trc; motion: .bvh, .vrma, .npz, .csv "
                   "or .mot")
      ->required();
  command->add_option("--up", args.up, "Up axis of INPUT, if the detected one is wrong")
      ->check(axis);
  command->add_option("--unit", args.unit, "Unit of INPUT, if its file is wrong")
      ->check(unit);
  command->add_option("--to-up", args.to_up, "Up axis of OUTPUT")->check(axis);
  command->add_option("--to-unit", args.to_unit, "Unit of OUTPUT")->check(unit);
  command->add_option(
      "--skeleton", args.skeleton, "The .asf of an .amc, if not in its folder");
  command
      ->add_option(
          "--rate", args.rate_hz, "Frame rate of INPUT [Hz], if its file is wrong")
      ->check(between(0.1, 2000.0));
  command->add_option("--to-rate", args.to_rate_hz, "Frames per second of OUTPUT")
      ->check(between(0.1, 2000.0));
  command->add_option("--bvh-dialect", args.bvh_dialect, "Program that reads the .bvh")
      ->check(one_of({"blender", "mobu", "maya", "unity"}));
  command->add_option("--neutral", args.neutral, kNeutralHelp)->check(neutral_mistake);
  command->add_flag("--json", args.json, "Print the figures as JSON on standard output");
  command->callback(
      [&] { chosen = [&args](Console& console) { return run_convert(args, console); }; });
}

}  // namespace marey::app
