// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/check/check_command.h"

#include <cstdio>
#include <span>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/library/check/check_json.h"
#include "app/library/check/check_page.h"
#include "app/library/check/check_text.h"
#include "app/library/check/library_check.h"
#include "app/library/find/query_clips.h"
#include "app/shell/option_checks.h"
#include "core/finding.h"
#include "recordings/base/atomic_file.h"
#include "recordings/library/library_file.h"
#include "recordings/library/library_records.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxTextClips = 20;

Result<std::vector<ClipRecord>> read_checked_clips(const LibraryCheckArguments& args) {
  const fs::path index = args.library / "library.sqlite";
  if (args.query.empty()) return recordings::read_library_records(index);
  const auto numbers = query_clips(args.library, args.query);
  if (!numbers) return numbers.error();
  return recordings::read_library_records(index, *numbers);
}

Result<LibraryCheck> make_check(const LibraryCheckArguments& args) {
  const auto settings = recordings::read_library(args.library / "library.toml");
  if (!settings) return settings.error();
  auto clips = read_checked_clips(args);
  if (!clips) return clips.error();
  // Sources without clips belong to no selection of clips.
  std::vector<FailedSource> failed;
  if (args.query.empty()) {
    auto read = read_failed_sources(args.library);
    if (!read) return read.error();
    failed = *std::move(read);
  }
  LibraryCheck check = check_library(
      *std::move(clips), library::QualityLimits(settings->limits), std::move(failed));
  check.library = settings->name;
  check.folder = args.library.string();
  check.query = args.query;
  return check;
}

void print_check(const LibraryCheck& check, bool as_json) {
  if (as_json) {
    using Json = nlohmann::ordered_json;
    std::printf(
        "%s\n",
        check_json(check).dump(1, ' ', false, Json::error_handler_t::replace).c_str());
    return;
  }
  for (const std::string& line : check_lines(check, kMaxTextClips)) {
    std::printf("%s\n", line.c_str());
  }
}

/// Writes the page. Returns false if a page that was asked for cannot be written.
bool write_check_page(const LibraryCheckArguments& args,
                      const LibraryCheck& check,
                      Console& console,
                      Exit& exit) {
  const bool is_asked_for = !args.page.empty();
  const fs::path page = is_asked_for ? args.page : args.library / "check.html";
  const Status ok = recordings::write_file(page, check_page(check));
  if (ok) {
    console.say("page: " + page.string());
    return true;
  }
  if (is_asked_for) {
    exit = console.fail(ok.error());
    return false;
  }
  console.warn(ok.error().message());
  return true;
}

Exit judge_check(const LibraryCheckArguments& args,
                 const LibraryCheck& check,
                 Console& console) {
  const int failing = check.by_verdict[2].clips;
  const int warning = args.fail_on == "warn" ? check.by_verdict[1].clips : 0;
  if (check.total.clips == 0) {
    console.warn(fair_finding("empty",
                              args.library.string(),
                              args.query.empty() ? "the library has no clips"
                                                 : "no clip fits the query",
                              args.query.empty()
                                  ? "name sources with marey library add"
                                  : "check its words with marey library query")
                     .message());
  }
  if (failing + warning == 0) return Exit::kOk;
  std::string cause = "clips that fail: " + std::to_string(failing);
  if (args.fail_on == "warn") cause += ", that warn: " + std::to_string(warning);
  return console.fail({Errc::kQuality,
                       args.library.string(),
                       cause,
                       "open the page, or play the clips with marey view " +
                           args.library.string() +
                           "; correct a wrong verdict there, or export with "
                           "--query quality=pass"});
}

}  // namespace

Exit run_library_check(const LibraryCheckArguments& args, Console& console) {
  if (!args.page.empty()) {
    if (const Status ok = check_out_file(args.page); !ok) return console.fail(ok.error());
  }
  const auto check = make_check(args);
  if (!check) return console.fail(check.error());
  print_check(*check, args.json);
  Exit exit = Exit::kOk;
  if (!write_check_page(args, *check, console, exit)) return exit;
  return judge_check(args, *check, console);
}

void add_library_check_command(CLI::App& library,
                               LibraryCheckArguments& args,
                               std::function<Exit(Console&)>& chosen) {
  CLI::App* command = library.add_subcommand(
      "check", "Print the quality of a library's clips, and write it as a page");
  command->add_option("LIB", args.library, "Folder of the library")->required();
  command->add_option("--query", args.query, "Checks only the clips that fit");
  command
      ->add_option(
          "--fail-on", args.fail_on, "Verdict that leads to exit code 4; default fail")
      ->check(one_of({"warn", "fail"}));
  command->add_flag("--json", args.json, "Prints the result with all clips as JSON");
  command->add_option(
      "--page", args.page, "File of the page; default check.html in the library");
  command->callback([&args, &chosen] {
    chosen = [&args](Console& console) { return run_library_check(args, console); };
  });
}

}  // namespace marey::app
