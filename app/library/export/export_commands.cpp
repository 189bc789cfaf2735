// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/export/export_commands.h"

#include <utility>

#include "app/library/export/export_folder.h"
#include "app/library/export/export_library.h"
#include "app/library/find/query_clips.h"
#include "app/library/labels/settings_digest.h"
#include "app/shell/option_checks.h"
#include "recordings/library/index_head.h"
#include "recordings/library/library_file.h"
#include "recordings/library/library_paths.h"
#include "recordings/library/library_records.h"

namespace marey::app {
namespace {

std::vector<std::string> format_words() {
  std::vector<std::string> out;
  for (const ExportFormat format : export_formats()) out.emplace_back(name(format));
  return out;
}

}  // namespace

namespace {

/// Checks that licences, labels and other settings are the same as in the index.
Status check_index_is_current(const std::filesystem::path& library,
                              const LibrarySettings& settings) {
  const auto head =
      recordings::read_index_head(recordings::LibraryPaths(library).index());
  if (!head) return head.error();
  const auto now = settings_digest(library, settings);
  if (!now) return now.error();
  if (head->settings.empty() || head->settings == *now) return Done{};
  return bad_input(library.string(),
                   "library.toml, a table or labels changed since the last build",
                   "build first, so that licences and labels are the current ones: marey "
                   "library build " +
                       library.string());
}

}  // namespace

Exit run_library_export(const LibraryExportArguments& args, Console& console) {
  const auto settings = recordings::read_library(args.library / "library.toml");
  if (!settings) return console.fail(settings.error());
  const auto options = resolve_export(args, *settings);
  if (!options) return console.fail(options.error());
  // Before the work of reading.
  if (const Status ok = check_export_folder(args.out, args.replace); !ok) {
    return console.fail(ok.error());
  }
  if (const Status ok = check_index_is_current(args.library, *settings); !ok) {
    return console.fail(ok.error());
  }
  const auto selected = query_clips(args.library, args.query);
  if (!selected) return console.fail(selected.error());
  auto records = recordings::read_library_records(args.library / "library.sqlite");
  if (!records) return console.fail(records.error());
  const auto report =
      export_library(*options, *std::move(records), *selected, console.stage("export"));
  if (!report) return console.fail(report.error());
  return print_export(*report, *options, args.json, console);
}

void add_library_export_command(CLI::App& library,
                                LibraryExportArguments& args,
                                std::function<Exit(Console&)>& chosen) {
  CLI::App* command = library.add_subcommand(
      "export", "Write clips of a library in a layout for other programs");
  command->add_option("LIB", args.library, "Folder of the library")->required();
  command->add_option("--to", args.out, "New folder of the export")->required();
  command->add_option("--as", args.format, "Layout")
      ->required()
      ->check(one_of(format_words()));
  command->add_option("--query", args.query, "Only clips that this expression selects");
  command->add_option("--skeleton",
                      args.skeleton,
                      "own, marey, smpl22, lafan22, or the file of a body; default: "
                      "library.toml's; smpl22 for amass and joints22, marey instead of "
                      "own for pack and matching");
  command
      ->add_option(
          "--rate", args.rate_hz, "Rate of the export [Hz]; default: library.toml's")
      ->check(between(0.1, 2000.0));
  command->add_flag(
      "--mirror", args.mirror, "Adds a copy of each clip with left and right exchanged");
  command->add_flag("--start-at-origin",
                    args.start_at_origin,
                    "Moves each clip so that its first frame is over the origin and "
                    "faces +Z");
  command->add_option("--split",
                      args.split,
                      "Percentages of train, val and test, such as 80/10/10; default: "
                      "library.toml's");
  command
      ->add_option("--by",
                   args.split_by,
                   "Unit that no split divides: a subject, or a clip with its copies")
      ->check(one_of({"subject", "clip"}));
  command
      ->add_option("--allow-licence",
                   args.allowed_licences,
                   "Licences that permit your use, separated by commas")
      ->allow_extra_args(false);
  command->add_flag("--licence-unknown",
                    args.licence_unknown,
                    "Exports also clips without a stated licence");
  command->add_flag(
      "--replace", args.replace, "Exchanges an earlier export in the folder");
  command->add_flag("--json", args.json, "Prints the results as JSON");
  command->callback([&args, &chosen] {
    chosen = [&args](Console& console) { return run_library_export(args, console); };
  });
}

}  // namespace marey::app
