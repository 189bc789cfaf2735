// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/edit/edit_events.h"
#include "app/edit/edit_messages.h"
#include "app/edit/edit_session.h"
#include "app/motion/motion_files.h"
#include "app/shell/console.h"
#include "app/view/page_server.h"
#include "live/web/web_server.h"

namespace marey::app {

/// Arguments of `marey edit MOTION|RECIPE --page`.
struct EditPageArguments {
  std::filesystem::path what;         ///< A recipe (.toml), or a motion of a new one.
  std::filesystem::path out;          ///< Folder of exports; empty: there are none.
  std::vector<MotionFormat> formats;  ///< Formats of exports; empty: as in EditOutput.
  bool accept_new_source = false;
  PageServerOptions page;
  std::optional<double> seconds;  ///< nullopt: until Ctrl-C.
};

/// Serves the edit page until Ctrl-C or the time limit. Prints the addresses on standard
/// output. A motion gets the recipe NAME.edit.toml next to it; if that exists, it is
/// opened.
Exit run_edit_page(const EditPageArguments& args, Console& console);

/// Sends the results of an edit to the pages: scene, rendered revisions, previews. Called
/// by the worker of one EditSession.
class EditPagePublisher : public EditListener {
 public:
  /// `server` must outlive the publisher.
  explicit EditPagePublisher(live::WebServer& server) : server_(server) {}

  void on_revision(const EditSession& session) override;
  void on_progress(const EditProgress& progress) override;
  void on_rendered(const EditResult& result) override;
  void on_preview(const EditAsker& asker,
                  const PreviewParts& parts,
                  const EditResult& result) override;
  void on_loops(const EditAsker& asker, const EditLoops& loops) override;
  void on_jump(const EditAsker& asker, const EditJump& jump) override;
  void on_exported(const EditAsker& asker, const EditExported& exported) override;
  void on_failed(const EditAsker& asker, const Error& error) override;

 private:
  using Paths = std::vector<std::string>;  ///< Size of the blocks of one message.

  [[nodiscard]] RenderedForm next_form();
  void serve(std::vector<EditBlock> blocks, std::size_t kept, std::deque<Paths>& served);
  [[nodiscard]] std::deque<Paths>& previews_of(std::uint64_t page);

  live::WebServer& server_;
  std::string scene_;  ///< The published one, with number 1.
  int scene_number_ = 0;
  std::uint64_t block_number_ = 0;
  std::deque<Paths> rendered_;
  std::map<std::uint64_t, std::deque<Paths>> previews_;  ///< By page.
};

/// Answers the messages of the pages of one session.
class EditPageDesk {
 public:
  /// Both must outlive the desk.
  EditPageDesk(EditSession& session, live::WebServer& server)
      : session_(session), server_(server) {}

  /// Carries out one message. Answers go to its page.
  void answer(const live::ReceivedText& text);

 private:
  [[nodiscard]] std::string carry_out(const EditAsker& asker,
                                      const live::EditPageRequest& request);

  EditSession& session_;
  live::WebServer& server_;
};

}  // namespace marey::app
