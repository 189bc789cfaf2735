// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "app/edit/edit_messages.h"
#include "app/edit/edit_session.h"
#include "tests/app/edit/arm_clip.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::app {

/// Keeps what a session reports.
class Reports : public EditListener {
 public:
  void on_revision(const EditSession& session) override {
    const std::lock_guard lock(mutex);
    EXPECT_FALSE(session.recipe_text().empty());
  }
  void on_progress(const EditProgress& progress) override {
    const std::lock_guard lock(mutex);
    last_progress = progress;
  }
  void on_rendered(const EditResult& result) override {
    const std::lock_guard lock(mutex);
    rendered.push_back(result.revision);
    frames = static_cast<int>(result.rendered.outputs.front().motion.poses.size());
    message = rendered_message(result, {.block_path = "/media/edit/1."});
  }
  void on_preview(const EditAsker& asker,
                  const PreviewParts& parts,
                  const EditResult& result) override {
    const std::lock_guard lock(mutex);
    previews.push_back(asker.id);
    preview_frames =
        static_cast<int>(result.rendered.outputs.front().motion.poses.size());
    preview = rendered_message(
        result, {.block_path = "/media/edit/2.", .parts = parts, .asker = &asker});
  }
  void on_loops(const EditAsker& /*asker*/, const EditLoops& found) override {
    const std::lock_guard lock(mutex);
    loops = found;
  }
  void on_jump(const EditAsker& /*asker*/, const EditJump& made) override {
    const std::lock_guard lock(mutex);
    jump = made;
  }
  void on_exported(const EditAsker& /*asker*/, const EditExported& written) override {
    const std::lock_guard lock(mutex);
    exported = written;
  }
  void on_failed(const EditAsker& asker, const Error& error) override {
    const std::lock_guard lock(mutex);
    failed[asker.id] = error.message();
  }

  std::mutex mutex;
  EditProgress last_progress;
  std::vector<int> rendered;
  int frames = 0;
  RenderedMessage message;
  std::vector<std::string> previews;
  int preview_frames = 0;
  RenderedMessage preview;
  EditLoops loops;
  EditJump jump;
  EditExported exported;
  std::map<std::string, std::string> failed;
};

/// A folder with a clip and a session on it.
class OpenedEdit {
 public:
  OpenedEdit() { testing::write_arm_clip(clip()); }

  [[nodiscard]] std::filesystem::path clip() const { return folder / "stand.bvh"; }
  [[nodiscard]] std::filesystem::path recipe() const {
    return folder / "stand.edit.toml";
  }
  [[nodiscard]] EditSessionOptions options() const {
    EditSessionOptions out;
    out.recipe_file = recipe();
    out.source = clip();
    out.output.out = folder / "out";
    out.output.formats = {MotionFormat::kNpz, MotionFormat::kBvh};
    return out;
  }
  void open() {
    session.reset();
    auto opened = EditSession::open(options(), reports);
    ASSERT_TRUE(opened) << opened.error().message();
    session = *std::move(opened);
  }
  [[nodiscard]] int number() const { return session->revision().number; }

  testing::ScratchFolder folder;
  Reports reports;
  std::unique_ptr<EditSession> session;
};

inline live::OpsPatchStep inserted(int at, const std::string& keys) {
  return {live::OpsPatchStep::Kind::kInsert, at, 0, false, "[[op]]\n" + keys};
}

/// Makes a revision; returns its number, or -1 with the reason in `reason`.
inline int changed(OpenedEdit& edit,
                   live::OpsPatch patch,
                   std::string* reason = nullptr) {
  const auto outcome = edit.session->edit({edit.number(), std::move(patch)});
  if (const auto* error = std::get_if<Error>(&outcome)) {
    if (reason != nullptr) *reason = error->message();
    return -1;
  }
  const auto* accepted = std::get_if<EditAccepted>(&outcome);
  return accepted == nullptr ? -1 : accepted->revision;
}

}  // namespace marey::app
