// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Undo and redo of an edit session, and its documents after the death of the program.
// Truth: an editor with two plain stacks of texts.
#include <chrono>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "app/edit/edit_session.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/sha256.h"
#include "recordings/edit/edit_recipe_file.h"
#include "tests/app/edit/opened_edit.h"
#include "tests/support/files/random_recipe.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/web_socket.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using Kind = live::OpsPatchStep::Kind;

/// Numbers that are the same on every machine.
class UndoDice {
 public:
  explicit UndoDice(std::uint64_t seed) : state_(seed) {}
  int below(std::size_t limit) {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<int>((state_ >> 33U) % limit);
  }

 private:
  std::uint64_t state_;
};

/// Returns an operation with random keys, as a page may send it.
std::string random_op(UndoDice& dice) {
  EditOp op = testing::random_edit_op(static_cast<std::uint64_t>(dice.below(10000)),
                                      static_cast<std::size_t>(dice.below(24)));
  // The one avatar that the recipe names; it does not exist.
  if (auto* retarget = std::get_if<RetargetOp>(&op.parameters)) {
    retarget->avatar = "avatar.glb";
    op.off = true;
  }
  return recordings::edit_op_text(op);
}

/// Returns a patch of one gesture on a recipe of this many operations: a drag replaces an
/// operation, a brush inserts one, and a menu does several steps at once.
live::OpsPatch random_gesture(UndoDice& dice, std::size_t count) {
  live::OpsPatch patch;
  for (int left = dice.below(4) == 0 ? 1 + dice.below(4) : 1; left > 0; --left) {
    live::OpsPatchStep step{Kind::kInsert, dice.below(count + 1), 0, false, {}};
    if (count >= 20 || (count > 0 && dice.below(3) != 0)) {
      step.kind = static_cast<Kind>(1 + dice.below(4));
      step.index = dice.below(count);
      step.to = dice.below(count);
      step.off = dice.below(2) == 0;
    }
    if (step.kind == Kind::kInsert || step.kind == Kind::kReplace) {
      step.op_toml = random_op(dice);
    }
    if (step.kind == Kind::kInsert) ++count;
    if (step.kind == Kind::kRemove) --count;
    patch.push_back(std::move(step));
  }
  return patch;
}

/// Writes a recipe with three sources and an avatar that is not used.
void write_full_recipe(const OpenedEdit& edit) {
  ASSERT_TRUE(recordings::write_file(
      edit.recipe(),
      "format = 1\n[[source]]\npath = \"stand.bvh\"\n[[source]]\nid = \"s1\"\n"
      "path = \"stand.bvh\"\n[[source]]\nid = \"s2\"\npath = \"stand.bvh\"\n"
      "[[op]]\ndo = \"retarget@1\"\navatar = \"avatar.glb\"\noff = true\n"));
}

TEST(EditUndo, RandomGesturesOfAllOperationsUndoneAndRedone) {
  OpenedEdit edit;
  write_full_recipe(edit);
  edit.open();
  const std::string first = edit.session->revision().sha256;
  std::string text = edit.session->recipe_text();
  UndoDice dice(23);
  std::vector<std::string> done;
  std::vector<std::string> undone;
  int gestures = 0;
  while (gestures < 500) {
    const int what = dice.below(10);
    const int number = edit.number();
    if (what == 0 && !done.empty()) {
      ASSERT_TRUE(std::holds_alternative<EditAccepted>(edit.session->undo({number})));
      undone.push_back(text);
      text = done.back();
      done.pop_back();
    } else if (what == 1 && !undone.empty()) {
      ASSERT_TRUE(std::holds_alternative<EditAccepted>(edit.session->redo({number})));
      done.push_back(text);
      text = undone.back();
      undone.pop_back();
    } else {
      const auto count = edit.session->recipe().ops.size();
      const auto outcome = edit.session->edit({number, random_gesture(dice, count)});
      // A patch that the recipe declines changes nothing.
      if (std::holds_alternative<EditAccepted>(outcome)) {
        done.push_back(text);
        undone.clear();
        text = edit.session->recipe_text();
        ++gestures;
      }
    }
    ASSERT_EQ(edit.session->recipe_text(), text);
    ASSERT_EQ(edit.session->revision().sha256, recordings::sha256(text));
  }
  EXPECT_EQ(*recordings::read_file(edit.recipe()), text);
  const std::string last = edit.session->revision().sha256;
  const std::size_t steps = done.size();
  for (std::size_t i = 0; i < steps; ++i) {
    ASSERT_TRUE(
        std::holds_alternative<EditAccepted>(edit.session->undo({edit.number()})));
    ASSERT_EQ(edit.session->recipe_text(), done[steps - 1 - i]);
  }
  EXPECT_EQ(edit.session->revision().sha256, first);
  EXPECT_FALSE(edit.session->can_undo());
  edit.open();  // A restart in between.
  for (std::size_t i = 0; i < steps; ++i) {
    ASSERT_TRUE(
        std::holds_alternative<EditAccepted>(edit.session->redo({edit.number()})));
  }
  EXPECT_EQ(edit.session->revision().sha256, last);
  EXPECT_FALSE(edit.session->can_redo());
}

TEST(EditUndo, AJournalOfAnotherRecipeIsKeptAsItsPast) {
  OpenedEdit edit;
  edit.open();
  ASSERT_EQ(changed(edit, {inserted(0, "do = \"mirror@1\"\n")}), 2);
  const std::string other = edit.session->recipe_text();
  edit.session.reset();
  // Another recipe takes its place: of another motion, with the journal of the first.
  testing::write_arm_clip(edit.folder / "other.bvh");
  ASSERT_TRUE(recordings::write_file(
      edit.recipe(), "format = 1\nname = \"other\"\n[source]\npath = \"other.bvh\"\n"));
  edit.open();
  EXPECT_EQ(edit.number(), 3);
  EXPECT_EQ(edit.session->revision().cause, EditCause::kFile);
  EXPECT_EQ(edit.session->recipe().name, "other");
  edit.session->wait_until_idle();
  EXPECT_EQ(edit.reports.rendered.back(), 3);
  // One undo away is the first recipe, with its own motion.
  ASSERT_TRUE(std::holds_alternative<EditAccepted>(edit.session->undo({3})));
  EXPECT_EQ(edit.session->recipe_text(), other);
  edit.session->wait_until_idle();
  EXPECT_EQ(edit.reports.rendered.back(), 4);
  EXPECT_EQ(edit.session->sources()[0].file, "stand.bvh");
}

TEST(EditUndo, AJournalThatIsTornAtAnyByteLosesItsLastLineAtMost) {
  OpenedEdit edit;
  edit.open();
  ASSERT_EQ(changed(edit, {inserted(0, "do = \"tag@1\"\ntext = \"gänge\"\n")}), 2);
  const std::string before = edit.session->recipe_text();
  ASSERT_EQ(changed(edit, {inserted(1, "do = \"mirror@1\"\n")}), 3);
  edit.session.reset();
  const fs::path journal = journal_of(edit.recipe());
  const std::string whole = *recordings::read_file(journal);
  const std::size_t last = whole.rfind('\n', whole.size() - 2) + 1;
  const std::string recipe = *recordings::read_file(edit.recipe());
  for (std::size_t size = last; size < whole.size(); ++size) {
    ASSERT_TRUE(recordings::write_file(journal, std::string_view(whole).substr(0, size)));
    ASSERT_TRUE(recordings::write_file(edit.recipe(), recipe));
    auto opened = EditJournal::open(journal);
    ASSERT_TRUE(opened) << size << ": " << opened.error().message();
    ASSERT_EQ(opened->revision_count(), 2) << size;
    ASSERT_EQ(opened->newest_text(), before);
    if (size % 16 != 0 && size + 1 != whole.size()) continue;
    { EditJournal closed = *std::move(opened); }
    // The session takes the change from the recipe.
    edit.open();
    ASSERT_EQ(edit.number(), 3);
    ASSERT_EQ(edit.session->recipe_text(), recipe);
    ASSERT_TRUE(std::holds_alternative<EditAccepted>(edit.session->undo({3})));
    ASSERT_EQ(edit.session->recipe_text(), before);
    edit.session.reset();
  }
}

/// A running `marey edit --page` of a clip.
class ServedProgram {
 public:
  explicit ServedProgram(const fs::path& motion) {
    int out[2]{};
    EXPECT_EQ(pipe2(out, O_CLOEXEC), 0);
    child_ = fork();
    if (child_ == 0) {
      dup2(out[1], STDOUT_FILENO);
      dup2(open("/dev/null", O_RDWR), STDERR_FILENO);
      const std::string program = testing::program();
      execl(program.c_str(),
            program.c_str(),
            "edit",
            motion.c_str(),
            "--page",
            "--port",
            "0",
            "--no-open",
            static_cast<char*>(nullptr));
      _exit(127);
    }
    close(out[1]);
    std::string text;
    for (char c = 0; read(out[0], &c, 1) == 1 && c != '\n';) text += c;
    out_ = out[0];
    const std::size_t colon = text.rfind(':');
    if (colon != std::string::npos) port = std::atoi(text.c_str() + colon + 1);
  }
  ~ServedProgram() {
    end();
    close(out_);
  }
  ServedProgram(const ServedProgram&) = delete;
  ServedProgram& operator=(const ServedProgram&) = delete;

  void end() {
    if (child_ <= 0) return;
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
    child_ = 0;
  }
  [[nodiscard]] pid_t process() const { return child_; }

  int port = 0;

 private:
  pid_t child_ = 0;
  int out_ = -1;
};

TEST(EditUndo, AKilledProgramKeepsEveryAcceptedChange) {
  const testing::ScratchFolder folder;
  testing::write_arm_clip(folder / "arm.bvh");
  int accepted = 1;
  for (int round = 0; round < 4; ++round) {
    {
      ServedProgram served(folder / "arm.bvh");
      ASSERT_GT(served.port, 0);
      testing::WebSocketClient page(served.port);
      ASSERT_EQ(testing::status(page.upgrade()), 101);
      for (int change = 0; change <= round; ++change) {
        const std::string base = std::to_string(accepted);
        page.send_frame(
            1,
            R"({"type":"edit","id":")" + base + R"(","base_revision":)" + base +
                R"(,"ops_patch":[{"insert":0,"op":{"do":"event@1","text":"e)" + base +
                R"(","at_s":0.5}}]})");
        const int wanted = accepted + 1;
        while (accepted < wanted) {
          const auto message = page.receive_message();
          ASSERT_TRUE(message);
          const auto json = nlohmann::json::parse(message->payload);
          ASSERT_NE(json.at("type"), "stale");
          if (json.at("type") == "accepted") accepted = json.at("revision");
        }
      }
      served.end();
    }
    auto journal = EditJournal::open(folder / "arm.edit.journal");
    ASSERT_TRUE(journal) << journal.error().message();
    EXPECT_EQ(journal->revision_count(), accepted);
    EXPECT_EQ(journal->newest_text(), *recordings::read_file(folder / "arm.edit.toml"));
  }
}

TEST(EditUndo, ASecondProgramIsRefusedWithTheProcessOfTheFirst) {
  const testing::ScratchFolder folder;
  testing::write_arm_clip(folder / "arm.bvh");
  ServedProgram served(folder / "arm.bvh");
  ASSERT_GT(served.port, 0);
  const std::string before = *recordings::read_file(folder / "arm.edit.toml");
  EditSessionOptions options;
  options.recipe_file = folder / "arm.edit.toml";
  Reports reports;
  const auto second = EditSession::open(options, reports);
  ASSERT_FALSE(second);
  const std::string message = second.error().message();
  EXPECT_NE(message.find("arm.edit.journal: is open in another marey"), std::string::npos)
      << message;
  if (fs::exists("/proc/locks")) {
    EXPECT_NE(message.find("(process " + std::to_string(served.process()) + ")"),
              std::string::npos)
        << message;
  }
  EXPECT_EQ(*recordings::read_file(folder / "arm.edit.toml"), before);
}

}  // namespace
}  // namespace marey::app
