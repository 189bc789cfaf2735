// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/labels/annotate_command.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <nlohmann/json.hpp>

#include "app/library/labels/import_labels.h"
#include "app/shell/word_list.h"
#include "core/base/in_quotes.h"
#include "core/base/printable.h"
#include "core/finding.h"
#include "recordings/library/label_file.h"
#include "recordings/library/library_records.h"
#include "recordings/library/verdict_file.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using AnnotateJson = nlohmann::ordered_json;

constexpr std::size_t kMaxNamedTargets = 5;

/// Checks that a name can be the name of a table of labels.
Status check_table_name(const std::string& name, const LibraryAnnotateArguments& args) {
  const bool is_reserved = name == "marey" || name + ".csv" == recordings::kVerdictFile ||
                           name + ".csv" == recordings::kPageLabelFile;
  const bool is_usable = !name.empty() && name.size() <= 100 && !name.starts_with('.') &&
                         name.find('/') == std::string::npos && printable(name) == name;
  if (is_usable && !is_reserved) return Done{};
  return bad_usage(
      args.by.empty() ? "--import" : "--by",
      in_quotes(name) + (is_reserved ? " is reserved: marey writes the table of that name"
                                     : " cannot be the name of a table in labels/"),
      "give --by with the name of the person or of the table");
}

void warn_of_names(const UnmatchedNames& unmatched,
                   const fs::path& file,
                   const std::string& cause,
                   const std::string& next,
                   Console& console) {
  if (unmatched.labels == 0) return;
  std::string names;
  for (std::size_t i = 0; i < std::min(unmatched.names.size(), kMaxNamedTargets); ++i) {
    names += (i == 0 ? "" : ", ") + in_quotes(unmatched.names[i]);
  }
  if (unmatched.names.size() > kMaxNamedTargets) {
    names +=
        " and " + std::to_string(unmatched.names.size() - kMaxNamedTargets) + " more";
  }
  console.warn(fair_finding("labels",
                            file.string(),
                            counted(unmatched.labels, "label") + " not used, as " +
                                cause + ": " + names,
                            next)
                   .message());
}

AnnotateJson unmatched_json(const UnmatchedNames& unmatched) {
  return {{"labels", unmatched.labels}, {"names", unmatched.names}};
}

std::string annotate_json_text(const ImportedLabels& labels, const StoredTable& stored) {
  constexpr const char* kStates[] = {"new", "unchanged", "replaced"};
  const AnnotateJson json = {{"format", 1},
                             {"file", stored.file.string()},
                             {"state", kStates[static_cast<int>(stored.state)]},
                             {"backup", stored.backup.string()},
                             {"labels", labels.rows.size()},
                             {"clips", labels.clips},
                             {"unknown", unmatched_json(labels.unknown)},
                             {"ambiguous", unmatched_json(labels.ambiguous)},
                             {"left_out", labels.left_out}};
  return json.dump(2, ' ', false, AnnotateJson::error_handler_t::replace);
}

void say_stored(const ImportedLabels& labels,
                const StoredTable& stored,
                const LibraryAnnotateArguments& args,
                Console& console) {
  const std::string about =
      counted(labels.rows.size(), "label") + " for " + counted(labels.clips, "clip");
  const std::string file = stored.file.string();
  if (stored.state == StoredTable::State::kUnchanged) {
    console.say(file + " has these " + about + " already: nothing to do");
    return;
  }
  if (stored.state == StoredTable::State::kReplaced) {
    console.say("the former table is " + stored.backup.string());
  }
  console.say(file + ": " + about + ". Next: marey library build " +
              args.library.string());
}

void report_unmatched(const ImportedLabels& labels,
                      const fs::path& file,
                      Console& console) {
  warn_of_names(labels.unknown,
                file,
                "no clip or source has their name",
                "compare the names with those of marey library query",
                console);
  warn_of_names(labels.ambiguous,
                file,
                "several sources have their name",
                "write the path of the source as in the library",
                console);
  if (labels.left_out > 0) {
    console.warn(
        fair_finding("labels",
                     file.string(),
                     std::to_string(labels.left_out) +
                         " labels have no text or impossible times, and are left out")
            .message());
  }
}

}  // namespace

Exit run_library_annotate(const LibraryAnnotateArguments& args, Console& console) {
  const std::string by = args.by.empty() ? args.import.stem().string() : args.by;
  if (const Status ok = check_table_name(by, args); !ok) return console.fail(ok.error());
  auto labels = read_imported_labels(args.import, by);
  if (!labels) return console.fail(labels.error());
  const auto records = recordings::read_library_records(args.library / "library.sqlite");
  if (!records) return console.fail(records.error());
  match_imported_labels(*records, *labels);
  report_unmatched(*labels, args.import, console);
  if (labels->rows.empty()) {
    return console.fail(
        bad_input(args.import.string(),
                  "none of its labels belongs to a clip of " + args.library.string(),
                  "name clips by their id, and sources by their path in the library"));
  }
  const auto stored = store_label_table(args.library / "labels" / (by + ".csv"),
                                        recordings::labels_text(labels->rows),
                                        args.replace);
  if (!stored) return console.fail(stored.error());
  if (args.json) std::printf("%s\n", annotate_json_text(*labels, *stored).c_str());
  say_stored(*labels, *stored, args, console);
  return Exit::kOk;
}

void add_library_annotate_command(CLI::App& library,
                                  LibraryAnnotateArguments& args,
                                  std::function<Exit(Console&)>& chosen) {
  CLI::App* command = library.add_subcommand(
      "annotate", "Store labels by people, for the next build of the library");
  command->add_option("LIB", args.library, "Folder of the library")->required();
  command
      ->add_option(
          "--import", args.import, "Table of labels (.csv), or a file of BABEL (.json)")
      ->required();
  command->add_option("--by",
                      args.by,
                      "Name of the table in labels/, and author of labels without one; "
                      "default: the name of the imported file");
  command->add_flag("--replace",
                    args.replace,
                    "Replaces the table, and keeps the former one next to it");
  command->add_flag("--json", args.json, "Prints the result as JSON");
  command->callback([&args, &chosen] {
    chosen = [&args](Console& console) { return run_library_annotate(args, console); };
  });
}

}  // namespace marey::app
