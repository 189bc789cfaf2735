// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/markers/repair_commands.h"

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "app/markers/marker_report.h"
#include "app/markers/repair_json.h"
#include "app/shell/option_checks.h"
#include "core/base/extension.h"
#include "recordings/base/atomic_file.h"
#include "recordings/markers/marker_file.h"

namespace marey::app {
namespace {

using reconstruct::RepairMethod;

std::string counted(std::size_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

/// Checks that the labels contain no comma, quote or line end, for the CSV table.
Status check_labels(const std::filesystem::path& file, const MarkerTracks& tracks) {
  for (const std::string& label : tracks.labels) {
    if (label.find_first_of(",\"\r\n") == std::string::npos) continue;
    return bad_input(file.string(),
                     "marker \"" + label + "\" has a comma, a quote or a line end in it",
                     "rename it");
  }
  return Done{};
}

void report_repair(const Repair& repair,
                   const std::filesystem::path& out,
                   Console& console) {
  const MarkerTracks& tracks = repair.repaired.tracks;
  for (const auto& finding : repair.checked.findings) {
    std::string text =
        tracks.labels[finding.marker] + ": " + std::string(name(finding.fault));
    if (finding.other) text += " with " + tracks.labels[*finding.other];
    const auto first = tracks.first_frame + static_cast<int>(finding.first);
    text += ", frames " + std::to_string(first) + " to " +
            std::to_string(first + static_cast<int>(finding.frames) - 1);
    console.warn(text);
  }
  std::size_t filled = 0;
  std::size_t empty = 0;
  for (const auto& gap : repair.repaired.gaps) {
    (gap.method == RepairMethod::kLeftEmpty ? empty : filled) += 1;
  }
  console.say(out.string() + ": " + counted(filled, "gap", "gaps") + " filled of " +
              std::to_string(filled + empty));
  if (empty > 0) {
    console.warn(counted(empty, "gap is", "gaps are") +
                 " left empty: no data determines them. Next: "
                 "find them in " +
                 out.filename().string() + ".repair.html");
  }
}

}  // namespace

Exit run_repair(const RepairArguments& args, Console& console) {
  std::error_code ignored;
  if (std::filesystem::equivalent(args.in, args.out, ignored)) {
    return console.fail(bad_input(args.out.string(),
                                  "the result would replace the file to repair",
                                  "give the result another name"));
  }
  for (const Status& ok :
       {check_out_file(args.out), recordings::check_marker_extension(args.out)}) {
    if (!ok) return console.fail(ok.error());
  }
  auto read = recordings::read_markers(args.in);
  if (!read) return console.fail(read.error());
  for (const std::string& note : read->notes) {
    console.warn(args.in.string() + ": " + note);
  }
  if (const Status ok = check_labels(args.in, read->tracks); !ok) {
    return console.fail(ok.error());
  }
  const auto& samples = read->tracks.samples;
  if (std::none_of(samples.begin(), samples.end(), [](const auto& s) { return s; })) {
    return console.fail(bad_input(args.in.string(),
                                  "no marker is seen in any frame",
                                  "check the file in the program that wrote it"));
  }
  Repair repair;
  repair.name = args.in.filename().string();
  repair.as_read = read->tracks;
  repair.checked = reconstruct::find_marker_faults(read->tracks);
  reconstruct::RepairOptions options;
  options.max_sigma_m = args.max_sigma_m;
  options.threads = 0;
  repair.repaired =
      reconstruct::repair_gaps(repair.checked.tracks, options, console.stage("gaps"));
  read->tracks = repair.repaired.tracks;
  recordings::MarkerWriteOptions write;
  const bool both_c3d =
      kind_by_extension(args.in) == ".c3d" && kind_by_extension(args.out) == ".c3d";
  if (both_c3d) write.source = args.in;
  if (kind_by_extension(args.in) == ".c3d" && kind_by_extension(args.out) == ".trc") {
    // A TRC does not store the up axis; readers assume Y up.
    write.axes = read->axes;
    write.axes->up = recordings::FileAxis::kPlusY;
  }
  constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;
  const std::string json = repair_json(repair).dump(1, ' ', false, kReplace) + "\n";
  // The markers are written first: if that fails, no other file is left behind.
  if (const Status ok = recordings::write_markers(args.out, *read, write); !ok) {
    return console.fail(ok.error());
  }
  for (const auto& [suffix, text] :
       {std::pair(".repair.json", json),
        std::pair(".repair.csv", repair_table(repair)),
        std::pair(".repair.html", repair_page(repair, read->notes))}) {
    const Status ok = recordings::write_file(args.out.string() + suffix, text);
    if (!ok) return console.fail(ok.error());
  }
  report_repair(repair, args.out, console);
  if (args.json) std::fputs(json.c_str(), stdout);
  return Exit::kOk;
}

void add_repair_command(CLI::App& app,
                        RepairArguments& args,
                        std::function<Exit(Console&)>& chosen) {
  CLI::App* command =
      app.add_subcommand("repair", "Fill the gaps of labelled markers (C3D, TRC)");
  command->add_option("INPUT", args.in, "Labelled markers, .c3d or .trc")->required();
  command->add_option("-o,--out", args.out, "Result: .c3d or .trc")->required();
  command
      ->add_option("--max-sigma",
                   args.max_sigma_m,
                   "Samples with a larger sigma are left empty [m]")
      ->check(between(0.001, 10.0));
  command
      ->add_option("--most-sigma", args.max_sigma_m)  // The former name, not listed.
      ->check(between(0.001, 10.0))
      ->group("");
  command->add_flag("--json", args.json, "Print OUT.repair.json on standard output");
  command->callback(
      [&] { chosen = [&args](Console& console) { return run_repair(args, console); }; });
}

}  // namespace marey::app
