// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/edit/edit_page.h"

#include <chrono>
#include <memory>
#include <type_traits>
#include <utility>
#include <variant>

#include "app/edit/edit_jump.h"
#include "app/shell/stop_signal.h"
#include "live/page/edit_request.h"
#include "live/page/page_scene.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using EditClock = std::chrono::steady_clock;

constexpr std::size_t kKeptRendered = 4;  ///< Messages whose blocks can be fetched.
constexpr std::size_t kKeptPreviews = 2;  ///< For each page.
constexpr std::size_t kMaxPreviewPages = 16;

live::ClientId client_of(const EditAsker& asker) {
  return live::ClientId{asker.page};
}

/// Returns the recipe of a motion: "walk.edit.toml" next to "walk.bvh".
fs::path recipe_beside(const fs::path& motion) {
  const fs::path named = motion.has_filename() ? motion : motion.parent_path();
  return named.parent_path() / (named.stem().string() + ".edit.toml");
}

EditSessionOptions session_options(const EditPageArguments& args) {
  EditSessionOptions out;
  const bool is_recipe = args.what.extension() == ".toml";
  out.recipe_file = is_recipe ? args.what : recipe_beside(args.what);
  if (!is_recipe) out.source = args.what;
  out.output = {args.out, args.formats};
  out.accept_new_sources = args.accept_new_source;
  return out;
}

/// Serves until Ctrl-C or the time limit.
Status serve_edit(const EditPageArguments& args,
                  live::WebServer& server,
                  EditSession& session) {
  constexpr std::chrono::milliseconds kLook{100};
  const auto end =
      EditClock::now() + std::chrono::duration_cast<EditClock::duration>(
                             std::chrono::duration<double>(args.seconds.value_or(0.0)));
  EditPageDesk desk(session, server);
  std::optional<WebRoot> root;
  if (!args.page.web_root.empty()) root.emplace(args.page.web_root);
  std::vector<live::ReceivedText> texts;
  while (!stop_wanted() && (!args.seconds || EditClock::now() < end)) {
    if (server.wait_for_text(kLook)) {
      server.take_texts(texts);
      for (const live::ReceivedText& text : texts) desk.answer(text);
    }
    if (const Status ok = session.sync_if_due(); !ok) return ok;
    if (!root) continue;
    if (const Status ok = root->serve(server); !ok) return ok;
  }
  return Done{};
}

}  // namespace

RenderedForm EditPagePublisher::next_form() {
  RenderedForm form;
  form.scene = scene_number_;
  form.block_path = "/media/edit/" + std::to_string(++block_number_) + ".";
  return form;
}

/// Serves the blocks of a message, and removes those of the oldest one.
void EditPagePublisher::serve(std::vector<EditBlock> blocks,
                              std::size_t kept,
                              std::deque<Paths>& served) {
  Paths& paths = served.emplace_back();
  for (EditBlock& block : blocks) {
    paths.push_back(block.path);
    server_.put({std::move(block.path),
                 "application/octet-stream",
                 std::make_shared<const std::string>(std::move(block.bytes)),
                 false,
                 {}});
  }
  if (served.size() <= kept) return;
  for (const std::string& path : served.front()) server_.remove(path);
  served.pop_front();
}

/// Returns the previews of a page. The messages of the oldest page are removed if there
/// are too many pages.
std::deque<EditPagePublisher::Paths>& EditPagePublisher::previews_of(std::uint64_t page) {
  std::deque<Paths>& out = previews_[page];
  if (previews_.size() > kMaxPreviewPages) {
    const auto oldest = previews_.begin()->first == page ? std::next(previews_.begin())
                                                         : previews_.begin();
    for (const Paths& paths : oldest->second) {
      for (const std::string& path : paths) server_.remove(path);
    }
    previews_.erase(oldest);
  }
  return out;
}

void EditPagePublisher::on_revision(const EditSession& session) {
  server_.publish_text(live::PageMessage::kRevision, revision_json(session));
}

void EditPagePublisher::on_progress(const EditProgress& progress) {
  server_.publish_text(live::PageMessage::kProgress, progress_json(progress));
}

void EditPagePublisher::on_rendered(const EditResult& result) {
  live::PageScene scene = edit_scene(result);
  std::string json = live::scene_json(scene);
  const bool is_new_scene = json != scene_;
  if (is_new_scene) {
    scene.revision = ++scene_number_;
    scene_ = std::move(json);
  }
  RenderedMessage message = rendered_message(result, next_form());
  serve(std::move(message.blocks), kKeptRendered, rendered_);
  if (is_new_scene) {
    server_.publish_text(live::PageMessage::kScene, live::scene_json(scene));
  }
  server_.publish_text(live::PageMessage::kRendered, message.json);
}

void EditPagePublisher::on_preview(const EditAsker& asker,
                                   const PreviewParts& parts,
                                   const EditResult& result) {
  RenderedForm form = next_form();
  form.parts = parts;
  form.asker = &asker;
  const std::string scene = live::scene_json(edit_scene(result));
  if (scene != scene_) {
    form.scene = 0;
    form.own_scene = scene;
  }
  RenderedMessage message = rendered_message(result, form);
  serve(std::move(message.blocks), kKeptPreviews, previews_of(asker.page));
  server_.queue_text(client_of(asker), message.json);
}

void EditPagePublisher::on_loops(const EditAsker& asker, const EditLoops& loops) {
  server_.queue_text(client_of(asker), loops_json(asker, loops));
}

void EditPagePublisher::on_jump(const EditAsker& asker, const EditJump& jump) {
  server_.queue_text(client_of(asker), jump_json(asker, jump));
}

void EditPagePublisher::on_exported(const EditAsker& asker,
                                    const EditExported& exported) {
  server_.queue_text(client_of(asker), exported_json(asker, exported));
}

void EditPagePublisher::on_failed(const EditAsker& asker, const Error& error) {
  server_.queue_text(client_of(asker), edit_error_json(asker, error.message()));
}

/// Returns the answer; empty: none now.
std::string EditPageDesk::carry_out(const EditAsker& asker,
                                    const live::EditPageRequest& request) {
  int base = 0;
  bool is_change = false;
  const auto outcome = std::visit(
      [&](const auto& body) -> EditOutcome {
        using Body = std::decay_t<decltype(body)>;
        if constexpr (requires { body.base_revision; }) base = body.base_revision;
        if constexpr (std::is_same_v<Body, live::PreviewRequest>) {
          return session_.preview(asker, body);
        } else if constexpr (std::is_same_v<Body, live::LoopsRequest>) {
          return session_.loops(asker, body);
        } else if constexpr (std::is_same_v<Body, live::JumpRequest>) {
          return session_.jump(asker, body);
        } else if constexpr (std::is_same_v<Body, live::ExportRequest>) {
          return session_.write(asker, body);
        } else if constexpr (std::is_same_v<Body, live::EditRequest>) {
          is_change = true;
          return session_.edit(body);
        } else if constexpr (std::is_same_v<Body, live::UndoRequest>) {
          is_change = true;
          return session_.undo(body);
        } else if constexpr (std::is_same_v<Body, live::RedoRequest>) {
          is_change = true;
          return session_.redo(body);
        } else {
          return EditAccepted{};  // `hello` and `shown` have no answer.
        }
      },
      request.body);
  if (const auto* stale = std::get_if<EditStale>(&outcome)) {
    return stale_json(asker, base, stale->newest);
  }
  if (const auto* error = std::get_if<Error>(&outcome)) {
    return edit_error_json(asker, error->message());
  }
  if (!is_change) return {};
  return accepted_json(asker, std::get<EditAccepted>(outcome).revision);
}

void EditPageDesk::answer(const live::ReceivedText& text) {
  EditAsker asker;
  asker.page = static_cast<std::uint64_t>(text.client);
  const auto request = live::read_edit_request(text.text);
  if (!request) {
    server_.queue_text(text.client, edit_error_json(asker, request.error().message()));
    return;
  }
  asker.about = request->type;
  asker.id = request->id;
  const std::string answer = carry_out(asker, *request);
  if (!answer.empty()) server_.queue_text(text.client, answer);
}

Exit run_edit_page(const EditPageArguments& args, Console& console) {
  auto page = start_page(args.page);
  if (!page) return console.fail(page.error());
  EditPagePublisher publisher(page->server);
  auto session = EditSession::open(session_options(args), publisher);
  if (!session) return console.fail(session.error());
  for (const std::string& remark : (*session)->remarks()) console.say(remark);
  console.say("recipe: " + (*session)->recipe_file().string());
  catch_stop_signals();
  print_addresses(*page, args.page);
  if (!args.seconds) console.say("open the address in a browser; Ctrl-C ends it");
  if (const Status ok = serve_edit(args, page->server, **session); !ok) {
    return console.fail(ok.error());
  }
  return Exit::kOk;
}

}  // namespace marey::app
