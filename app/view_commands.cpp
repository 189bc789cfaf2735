// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/view_commands.h"

#include <chrono>
#include <utility>
#include <variant>
#include <vector>

#include "app/option_checks.h"
#include "app/stop_signal.h"
#include "app/view_page.h"
#include "live/page_request.h"
#include "live/page_status.h"

namespace marey::app {
namespace {

using Clock = std::chrono::steady_clock;

/// What a page may ask of a recording that only plays; empty: it was a greeting.
std::string refusal_of(const std::string& text) {
  const auto request = live::read_page_request(text);
  if (!request) return request.error().message();
  const bool harmless = std::holds_alternative<live::HelloRequest>(*request) ||
                        std::holds_alternative<live::ShownRequest>(*request) ||
                        std::holds_alternative<live::ThumbnailsRequest>(*request);
  return harmless ? std::string() : "a recording is only looked at here";
}

void hear(live::WebServer& server, std::vector<live::ReceivedText>& texts) {
  server.take_texts(texts);
  for (const live::ReceivedText& text : texts) {
    const std::string refusal = refusal_of(text.text);
    if (!refusal.empty()) server.answer_text(text.client, live::error_json(refusal));
  }
}

/// Until Ctrl-C or the time is over.
Status serve(live::WebServer& server, const ViewArguments& args) {
  constexpr std::chrono::milliseconds kLook{100};
  const auto end =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(
                         std::chrono::duration<double>(args.seconds.value_or(0.0)));
  std::optional<WebRoot> root;
  if (!args.page.web_root.empty()) root.emplace(args.page.web_root);
  std::vector<live::ReceivedText> texts;
  while (!stop_wanted() && (!args.seconds || Clock::now() < end)) {
    if (server.wait_for_text(kLook)) hear(server, texts);
    if (!root) continue;
    if (Status ok = root->serve(server); !ok) return ok;
  }
  return Done{};
}

}  // namespace

Exit run_view(const ViewArguments& args, Console& console) {
  const auto recording = read_view(args.choice);
  if (!recording) return console.fail(recording.error());
  for (const std::string& remark : recording->remarks) console.say(remark);
  auto encoded = page_of_recording(*recording);
  if (!encoded) return console.fail(encoded.error());
  auto page = start_page(args.page);
  if (!page) return console.fail(page.error());
  for (live::WebContent& content : encoded->media) page->server.put(std::move(content));
  page->server.publish_text(live::PageMessage::kScene, live::scene_json(encoded->scene));
  catch_stop_signals();
  tell_addresses(*page, args.page);
  if (!args.seconds) console.say("open the address in a browser; Ctrl-C ends it");
  if (const Status ok = serve(page->server, args); !ok) return console.fail(ok.error());
  return Exit::kOk;
}

void add_page_options(CLI::App& command, PageServerOptions& options) {
  command.add_option("--port", options.port, "Port of the page; 0: any that is free")
      ->check(CLI::Range(0, 65535));
  command.add_flag(
      "--lan", options.lan, "Let other machines look, by an address with a token");
  command.add_option(
      "--web-root",
      options.web_root,
      "Serve the page from this folder, as it changes, for its development");
  command.add_flag_callback(
      "--no-open", [&options] { options.open = false; }, "Open no browser");
}

void add_view_command(CLI::App& app,
                      ViewArguments& args,
                      std::function<Exit(Console&)>& chosen) {
  CLI::App* command = app.add_subcommand(
      "view", "Show a motion, markers, cameras or results in a browser");
  command
      ->add_option("what",
                   args.choice.what,
                   ".bvh, .amc, .glb, .gltf, .vrm, .vrma, .c3d, .trc, calibration.toml, "
                   "or a folder of "
                   "results")
      ->required();
  command->add_option("--trial", args.choice.trial, "Which trial of a folder of results");
  command
      ->add_option("-a,--avatar",
                   args.choice.avatars,
                   "Body to show the motion on, too (.glb, .vrm, .bvh); may be repeated")
      ->allow_extra_args(false);
  add_page_options(*command, args.page);
  command->add_option("--seconds", args.seconds, "Stop by itself after so long")
      ->check(between(0.001, 1e6));
  command->callback(
      [&] { chosen = [&args](Console& console) { return run_view(args, console); }; });
}

}  // namespace marey::app
