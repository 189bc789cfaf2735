// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/find/similar_command.h"

#include <cstdio>
#include <utility>
#include <vector>

#include "app/library/find/clip_table.h"
#include "app/shell/option_checks.h"
#include "core/base/format_text.h"

namespace marey::app {
namespace {

void print_similar_rows(const std::vector<SimilarClip>& clips) {
  std::vector<std::vector<std::string>> rows;
  for (const SimilarClip& one : clips) {
    rows.push_back({one.clip.clip_id,
                    one.clip.name,
                    format_text("%.1f-%.1f s", one.start_s, one.end_s),
                    format_text("%.3f", one.distance),
                    label_list(one.clip)});
  }
  std::fputs(table_text(rows).c_str(), stdout);
}

void print_similar_json(const SimilarQuery& query, const SimilarClips& found) {
  nlohmann::ordered_json json{{"query", query.name}, {"remarks", found.remarks}};
  json["clips"] = nlohmann::ordered_json::array();
  for (const SimilarClip& one : found.clips) {
    nlohmann::ordered_json row = clip_json(one.clip);
    row["start_s"] = one.start_s;
    row["end_s"] = one.end_s;
    row["distance"] = one.distance;
    json["clips"].push_back(std::move(row));
  }
  print_library_json(json);
}

}  // namespace

Exit run_library_similar(const LibrarySimilarArguments& args, Console& console) {
  const auto search = open_search(args.library);
  if (!search) return console.fail(search.error());
  const auto query = read_similar_query(args.library, args.query, *search);
  if (!query) return console.fail(query.error());
  const auto found = find_similar_clips(args.library, *query, *search, args.options);
  if (!found) return console.fail(found.error());
  for (const std::string& remark : found->remarks) console.warn(remark);
  if (args.json) {
    print_similar_json(*query, *found);
    return Exit::kOk;
  }
  print_similar_rows(found->clips);
  if (found->clips.empty()) console.say("no clip is long enough to be compared");
  return Exit::kOk;
}

void add_library_similar_command(CLI::App& library,
                                 LibrarySimilarArguments& args,
                                 std::function<Exit(Console&)>& chosen) {
  CLI::App* command =
      library.add_subcommand("similar", "List the clips that are similar to a motion");
  command->add_option("LIB", args.library, "Folder of the library")->required();
  command
      ->add_option("CLIP",
                   args.query,
                   "Clip (its id, the beginning of its id, or its name) or motion file; "
                   "@1.5-3 after it: this part, in seconds")
      ->required();
  SimilarClipsOptions& options = args.options;
  command->add_flag("--mirror", options.mirror, "Searches for the mirror image");
  command->add_flag(
      "--exact", options.exact, "Compares every clip, not only the best of a scan");
  command->add_flag(
      "--whole", options.whole_clips, "Compares whole clips with the whole motion");
  command->add_option("--top", options.top, "Number of clips (default 10)")
      ->check(whole_between(1, 1'000'000));
  command
      ->add_option("--length",
                   options.length_s,
                   "Uses the middle of a longer motion [s]; default 2, or all of it with "
                   "--whole or @")
      ->check(between(0.1, 3600.0));
  command->add_option(
      "--query", options.query, "Searches only the clips that this expression selects");
  command->add_flag("--json", args.json, "Prints JSON on standard output");
  command->callback([&] {
    chosen = [&args](Console& console) { return run_library_similar(args, console); };
  });
}

}  // namespace marey::app
