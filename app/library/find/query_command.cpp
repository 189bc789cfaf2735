// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/find/query_command.h"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <span>
#include <vector>

#include "app/library/find/clip_table.h"
#include "app/library/find/query_clips.h"
#include "app/shell/option_checks.h"
#include "core/base/format_text.h"
#include "recordings/library/library_records.h"

namespace marey::app {
namespace {

void print_clip_rows(const std::vector<recordings::ClipSummary>& clips) {
  std::vector<std::vector<std::string>> rows;
  for (const recordings::ClipSummary& clip : clips) {
    rows.push_back({clip.clip_id,
                    clip.name,
                    format_text("%8.2f s", clip.duration_s),
                    std::string(name(clip.quality)),
                    label_list(clip)});
  }
  std::fputs(table_text(rows).c_str(), stdout);
}

}  // namespace

Exit run_library_query(const LibraryQueryArguments& args, Console& console) {
  const auto query = run_clip_query(args.library, args.expression);
  if (!query) return console.fail(query.error());
  for (const std::string& remark : query->remarks) console.warn(remark);
  const std::size_t count = query->numbers.size();
  const std::size_t listed =
      args.limit > 0 ? std::min(count, static_cast<std::size_t>(args.limit)) : count;
  if (args.count && !args.json) {
    std::printf("%zu\n", count);
    return Exit::kOk;
  }
  const auto clips = recordings::read_clip_summaries(
      args.library / "library.sqlite",
      std::span(query->numbers).first(args.count ? 0 : listed));
  if (!clips) return console.fail(clips.error());
  if (args.json) {
    nlohmann::ordered_json json{{"count", count}, {"remarks", query->remarks}};
    if (!args.count) {
      json["clips"] = nlohmann::ordered_json::array();
      for (const auto& clip : *clips) json["clips"].push_back(clip_json(clip));
    }
    print_library_json(json);
    return Exit::kOk;
  }
  print_clip_rows(*clips);
  console.say(listed < count ? format_text("%zu of %zu clips", listed, count)
                             : format_text("%zu clips", count));
  return Exit::kOk;
}

void add_library_query_command(CLI::App& library,
                               LibraryQueryArguments& args,
                               std::function<Exit(Console&)>& chosen) {
  CLI::App* command =
      library.add_subcommand("query", "List the clips that an expression selects");
  command->add_option("LIB", args.library, "Folder of the library")->required();
  command->add_option("EXPR",
                      args.expression,
                      "Expression such as 'content=walk and quality=pass'; empty: all "
                      "clips (docs/library_queries.md)");
  command->add_option("--limit", args.limit, "Maximum number of clips listed; 0: all")
      ->check(whole_between(0, 1'000'000'000));
  command->add_flag("--count", args.count, "Prints the number of clips only");
  command->add_flag("--json", args.json, "Prints JSON on standard output");
  command->callback([&] {
    chosen = [&args](Console& console) { return run_library_query(args, console); };
  });
}

}  // namespace marey::app
