// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/view/view_commands.h"

#include <algorithm>
#include <chrono>
#include <utility>
#include <variant>
#include <vector>

#include "app/motion/raw_body.h"
#include "app/shell/option_checks.h"
#include "app/shell/stop_signal.h"
#include "app/view/view_page.h"
#include "app/view/view_trials.h"
#include "live/page/page_request.h"
#include "live/page/page_scene.h"
#include "live/page/page_status.h"

namespace marey::app {
namespace {

using Clock = std::chrono::steady_clock;

/// Processes one message and returns the reply to the page; empty: no reply. Sets `drags`
/// if the page needs a frame.
std::string note(const live::ReceivedText& text,
                 live::WebServer& server,
                 ViewTrials& trials,
                 bool& drags) {
  const auto request = live::read_page_request(text.text);
  if (!request) return live::error_json(request.error().message());
  ViewHandles& handles = trials.seen_by(text.client).handles;
  if (const auto* drag = std::get_if<live::DragRequest>(&*request)) {
    const Status ok = handles.drag(text.client, *drag);
    if (!ok) return live::error_json(ok.error().message());
    drags = true;
    return {};
  }
  if (const auto* hold = std::get_if<live::ConstraintRequest>(&*request)) {
    drags = !hold->active && handles.release(text.client, hold->id);
    // The page has already shown the change.
    return drags ? std::string() : live::constraints_json(handles.constraints());
  }
  if (const auto* other = std::get_if<live::TrialRequest>(&*request)) {
    const auto scene = trials.show(text.client, other->name, server);
    return scene ? std::string(*scene) : live::error_json(scene.error().message());
  }
  const bool harmless = std::holds_alternative<live::HelloRequest>(*request) ||
                        std::holds_alternative<live::ShownRequest>(*request) ||
                        std::holds_alternative<live::ThumbnailsRequest>(*request);
  return harmless ? std::string()
                  : live::error_json("this page can only show a recording");
}

void answer(live::WebServer& server, const ViewedTrial& shown, live::ClientId client) {
  const auto answered = shown.handles.adapted(client);
  if (!answered) return;  // Too many other pages have dragged since.
  const Result<ViewHandles::Adapted>& adapted = *answered;
  if (!adapted) {
    server.answer_text(client, live::error_json(adapted.error().message()));
    return;
  }
  server.answer_frame(
      client,
      frame_with(shown.recording, adapted->frame, shown.handles.figure(), adapted->pose));
}

/// Replies to the pages. Only the last drag of a page is processed, and none after a
/// change to another trial.
void answer_pages(live::WebServer& server,
                  std::vector<live::ReceivedText>& texts,
                  ViewTrials& trials) {
  server.take_texts(texts);
  std::vector<std::pair<live::ClientId, const ViewedTrial*>> dragging;
  for (const live::ReceivedText& text : texts) {
    bool drags = false;
    const std::string said = note(text, server, trials, drags);
    if (!said.empty()) server.answer_text(text.client, said);
    const std::pair<live::ClientId, const ViewedTrial*> one{text.client,
                                                            &trials.seen_by(text.client)};
    if (drags && std::ranges::find(dragging, one) == dragging.end()) {
      dragging.push_back(one);
    }
  }
  for (const auto& [client, shown] : dragging) {
    if (shown == &trials.seen_by(client)) answer(server, *shown, client);
  }
}

/// Serves until Ctrl-C or the time limit.
Status serve(live::WebServer& server, const ViewArguments& args, ViewTrials& trials) {
  constexpr std::chrono::milliseconds kLook{100};
  const auto end =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(
                         std::chrono::duration<double>(args.seconds.value_or(0.0)));
  std::optional<WebRoot> root;
  if (!args.page.web_root.empty()) root.emplace(args.page.web_root);
  std::vector<live::ReceivedText> texts;
  while (!stop_wanted() && (!args.seconds || Clock::now() < end)) {
    if (server.wait_for_text(kLook)) answer_pages(server, texts, trials);
    if (!root) continue;
    if (Status ok = root->serve(server); !ok) return ok;
  }
  return Done{};
}

}  // namespace

Exit run_view(const ViewArguments& args, Console& console) {
  auto trials = ViewTrials::open(args.choice, args.constraints);
  if (!trials) return console.fail(trials.error());
  for (const std::string& remark : trials->first().recording.remarks) console.say(remark);
  auto page = start_page(args.page);
  if (!page) return console.fail(page.error());
  trials->serve(page->server);
  page->server.publish_text(live::PageMessage::kScene, trials->first().scene);
  catch_stop_signals();
  print_addresses(*page, args.page);
  if (!args.seconds) console.say("open the address in a browser; Ctrl-C ends it");
  if (const Status ok = serve(page->server, args, *trials); !ok)
    return console.fail(ok.error());
  return Exit::kOk;
}

void add_page_options(CLI::App& command, PageServerOptions& options) {
  command.add_option("--port", options.port, "Port of the page; 0: any free port")
      ->check(whole_between(0, 65535));
  command.add_flag(
      "--lan", options.lan, "Allow other machines, by an address with a token");
  command.add_option("--web-root",
                     options.web_root,
                     "Serve the page from this folder, for its development");
  command.add_flag_callback(
      "--no-open", [&options] { options.open = false; }, "Open no browser");
}

void add_view_command(CLI::App& app,
                      ViewArguments& args,
                      FolderView library,
                      std::function<Exit(Console&)>& chosen) {
  CLI::App* command = app.add_subcommand(
      "view", "Show a motion, markers, cameras or results in a browser");
  command
      ->add_option("FILE",
                   args.choice.what,
                   "Motion (" + body_extensions() +
                       "), markers (.c3d or .trc), a calibration.toml, a folder of "
                       "results, a take of marey live or a motion library")
      ->required();
  command->add_option("--trial", args.choice.trial, "Which trial of a folder of results");
  command
      ->add_option(
          "-a,--avatar",
          args.choice.avatars,
          "Body to retarget the motion to: " + body_extensions() + "; may be repeated")
      ->allow_extra_args(false);
  command->add_option("-x,--constraints",
                      args.constraints,
                      "Constraints (.xml) for frames with dragged handles");
  command->add_option(
      "--query", args.query, "Clips of a motion library to list: marey library query");
  add_page_options(*command, args.page);
  command->add_option("--seconds", args.seconds, "Stop after this time [s]")
      ->check(between(0.001, 1e6));
  command->callback([&args, &chosen, library = std::move(library)] {
    if (library.fits(args.choice.what)) {
      chosen = [&args, run = library.run](Console& console) {
        return run(args, console);
      };
      return;
    }
    if (!args.query.empty()) {
      throw RejectedArguments(
          "--query is for motion libraries, which have a library.toml",
          "leave it out, or give the folder of a library");
    }
    chosen = [&args](Console& console) { return run_view(args, console); };
  });
}

}  // namespace marey::app
