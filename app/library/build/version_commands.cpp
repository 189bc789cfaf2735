// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/build/version_commands.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/shell/option_checks.h"
#include "core/base/format_text.h"
#include "core/base/printable.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/sha256.h"
#include "recordings/library/file_stat.h"
#include "recordings/library/index_head.h"
#include "recordings/library/library_paths.h"
#include "recordings/library/version_file.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using recordings::ClipChange;
using recordings::VersionLine;
using VersionJson = nlohmann::ordered_json;

constexpr long kMaxVersion = 1'000'000;

struct ReadVersion {
  std::string sha256;
  std::vector<VersionLine> lines;
};

Result<ReadVersion> read_version(const fs::path& library, int number) {
  const fs::path file = recordings::version_path(library, number);
  std::error_code failed;
  if (!fs::exists(file, failed)) {
    return bad_input(library.string(),
                     "it has no version " + std::to_string(number),
                     "see marey library versions LIB");
  }
  const auto text = recordings::read_file(file);
  if (!text) return text.error();
  auto lines = recordings::parse_version(*text, file.string());
  if (!lines) return lines.error();
  return ReadVersion{recordings::sha256(*text), std::move(*lines)};
}

/// Returns the day and time at which a file was written.
std::string written_at(const fs::path& file) {
  constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
  const auto state = recordings::stat_file(file);
  if (!state) return "unknown";
  const std::time_t seconds = state->changed_ns / kNanosecondsPerSecond;
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text.data();
}

std::size_t count_quality(const std::vector<VersionLine>& lines, const char* word) {
  return static_cast<std::size_t>(std::ranges::count(lines, word, &VersionLine::quality));
}

Error no_versions(const fs::path& library) {
  return bad_input(library.string(),
                   "the library has no versions yet",
                   "build it: marey library build LIB");
}

std::string what_changed(const ClipChange& change) {
  if (change.quality_before.empty()) return "new, " + change.quality_after;
  if (change.quality_after.empty()) return "gone";
  std::string out;
  const auto add = [&](bool is_new, const std::string& word) {
    if (is_new) out += (out.empty() ? "" : ", ") + word;
  };
  add(change.has_new_source, "source");
  add(change.has_new_motion, "motion");
  add(change.quality_before != change.quality_after,
      "quality " + change.quality_before + " -> " + change.quality_after);
  add(change.has_new_labels, "labels");
  add(change.has_new_licence, "licence");
  add(change.has_new_name, "name");
  if (out.empty()) out = "subject, origin, figures, split or duplicates";
  return out;
}

VersionJson change_json(const ClipChange& change) {
  return {{"clip", change.clip_id},
          {"name", change.name},
          {"quality_before", change.quality_before},
          {"quality_after", change.quality_after},
          {"source", change.has_new_source},
          {"motion", change.has_new_motion},
          {"labels", change.has_new_labels},
          {"licence", change.has_new_licence},
          {"record", change.has_new_state}};
}

}  // namespace

Exit run_library_versions(const LibraryVersionArguments& args, Console& console) {
  const auto versions = recordings::list_versions(args.library);
  if (versions.empty()) return console.fail(no_versions(args.library));
  const auto head =
      recordings::read_index_head(recordings::LibraryPaths(args.library).index());
  VersionJson list = VersionJson::array();
  for (const recordings::LibraryVersion& version : versions) {
    const auto read = read_version(args.library, version.number);
    if (!read) return console.fail(read.error());
    const std::size_t warned = count_quality(read->lines, "warn");
    const std::size_t failed = count_quality(read->lines, "fail");
    const bool is_current = head && head->version == version.number;
    const std::string time = written_at(version.path);
    list.push_back({{"version", version.number},
                    {"sha256", read->sha256},
                    {"written", time},
                    {"clips", read->lines.size()},
                    {"warned", warned},
                    {"failed", failed},
                    {"is_current", is_current}});
    if (args.json) continue;
    std::printf("%4d  %s  %s  %zu clips, %zu warned, %zu failed%s\n",
                version.number,
                read->sha256.substr(0, 16).c_str(),
                time.c_str(),
                read->lines.size(),
                warned,
                failed,
                is_current ? "  (current)" : "");
  }
  if (args.json) std::printf("%s\n", list.dump(2).c_str());
  return Exit::kOk;
}

Exit run_library_diff(const LibraryVersionArguments& args, Console& console) {
  const auto before = read_version(args.library, args.before);
  if (!before) return console.fail(before.error());
  const auto after = read_version(args.library, args.after);
  if (!after) return console.fail(after.error());
  const auto changes = recordings::compare_versions(before->lines, after->lines);
  if (args.json) {
    VersionJson list = VersionJson::array();
    for (const ClipChange& change : changes) list.push_back(change_json(change));
    std::printf("%s\n", list.dump(2).c_str());
    return Exit::kOk;
  }
  for (const ClipChange& change : changes) {
    std::printf("%s  %s: %s\n",
                change.clip_id.c_str(),
                printable(change.name).c_str(),
                what_changed(change).c_str());
  }
  console.say(format_text("%zu clips differ between versions %d and %d",
                          changes.size(),
                          args.before,
                          args.after));
  return Exit::kOk;
}

void add_library_version_commands(CLI::App& library,
                                  LibraryVersionArguments& args,
                                  std::function<Exit(Console&)>& chosen) {
  CLI::App* versions = library.add_subcommand("versions", "List the versions");
  CLI::App* diff = library.add_subcommand("diff", "Compare two versions");
  for (CLI::App* command : {versions, diff}) {
    command->add_option("LIB", args.library, "folder of the library")->required();
    command->add_flag("--json", args.json, "print JSON");
  }
  diff->add_option("BEFORE", args.before, "number of a version")
      ->required()
      ->check(whole_between(1, kMaxVersion));
  diff->add_option("AFTER", args.after, "number of a version")
      ->required()
      ->check(whole_between(1, kMaxVersion));
  versions->callback([&] {
    chosen = [&args](Console& console) { return run_library_versions(args, console); };
  });
  diff->callback([&] {
    chosen = [&args](Console& console) { return run_library_diff(args, console); };
  });
}

}  // namespace marey::app
