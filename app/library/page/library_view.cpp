// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/page/library_view.h"

#include <chrono>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "app/library/page/library_page_server.h"
#include "app/shell/stop_signal.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using LibraryClock = std::chrono::steady_clock;

/// Returns the first option that a library does not have.
std::optional<Error> refused_option(const ViewArguments& args) {
  const auto refuse = [&](const char* option) {
    return bad_usage(option,
                     args.choice.what.string() + " is a motion library",
                     "leave the option out, or give a motion");
  };
  if (!args.choice.trial.empty()) return refuse("--trial");
  if (!args.choice.avatars.empty()) return refuse("--avatar");
  if (!args.constraints.empty()) return refuse("--constraints");
  return std::nullopt;
}

/// Serves until Ctrl-C or the time limit.
Status serve_library(const ViewArguments& args,
                     live::WebServer& server,
                     LibraryPageServer& library_server) {
  constexpr std::chrono::milliseconds kLook{250};
  const auto end = LibraryClock::now() +
                   std::chrono::duration_cast<LibraryClock::duration>(
                       std::chrono::duration<double>(args.seconds.value_or(0.0)));
  std::optional<WebRoot> root;
  if (!args.page.web_root.empty()) root.emplace(args.page.web_root);
  std::vector<live::ReceivedText> texts;
  while (!stop_wanted() && (!args.seconds || LibraryClock::now() < end)) {
    const bool has_text = server.wait_for_text(kLook);
    library_server.look();
    if (has_text) {
      server.take_texts(texts);
      for (const live::ReceivedText& text : texts) library_server.answer(text);
    }
    if (!root) continue;
    if (Status ok = root->serve(server); !ok) return ok;
  }
  return Done{};
}

}  // namespace

bool is_library_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path / "library.toml", ignored);
}

Exit run_library_view(const ViewArguments& args, Console& console) {
  if (const auto error = refused_option(args)) return console.fail(*error);
  auto page = start_page(args.page);
  if (!page) return console.fail(page.error());
  LibraryPageServer library_server(args.choice.what, args.query, page->server);
  const LibraryState& state = library_server.state();
  if (!state.trouble.empty()) console.warn(state.trouble);
  console.say(std::to_string(state.clips) + " clips");
  catch_stop_signals();
  print_addresses(*page, args.page);
  if (!args.seconds) console.say("open the address in a browser; Ctrl-C ends it");
  if (const Status ok = serve_library(args, page->server, library_server); !ok) {
    return console.fail(ok.error());
  }
  return Exit::kOk;
}

FolderView library_folder_view() {
  return {is_library_folder, run_library_view};
}

}  // namespace marey::app
