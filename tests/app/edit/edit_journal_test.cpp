// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// The journal of an edit. Truth: the texts that were added.
#include "app/edit/edit_journal.h"

#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "recordings/base/atomic_file.h"
#include "recordings/base/sha256.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using testing::ScratchFolder;

/// Numbers that are the same on every machine.
class GestureDice {
 public:
  explicit GestureDice(std::uint64_t seed) : state_(seed) {}
  std::size_t below(std::size_t limit) {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<std::size_t>(state_ >> 33U) % limit;
  }

 private:
  std::uint64_t state_;
};

/// Changes a text as a gesture changes a recipe; umlauts have two bytes, arrows three.
std::string gesture(const std::string& text, GestureDice& dice) {
  const std::vector<std::string> words{
      "\n[[op]]\ndo = \"cut@1\"\n", "ä", "ö", "→", "from_s = 1.25\n", "\\\"", ""};
  std::size_t at = dice.below(text.size() + 1);
  while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xc0U) == 0x80U) {
    ++at;
  }
  std::string out = text.substr(0, at) + words[dice.below(words.size())];
  std::size_t from = at;
  if (dice.below(3) == 0) {
    from = std::min(text.size(), at + dice.below(20));
    while (from < text.size() &&
           (static_cast<unsigned char>(text[from]) & 0xc0U) == 0x80U) {
      ++from;
    }
  }
  return out + text.substr(from);
}

EditJournal opened(const fs::path& path) {
  auto journal = EditJournal::open(path);
  EXPECT_TRUE(journal) << journal.error().message();
  return *std::move(journal);
}

std::string content(const fs::path& path) {
  return *recordings::read_file(path);
}

TEST(EditJournal, UndoesAndRedoes500RandomGesturesToTheSameHashes) {
  const ScratchFolder folder;
  const fs::path path = folder.path() / "walk.edit.journal";
  GestureDice dice(7);
  std::string first;
  std::string last;
  {
    EditJournal journal = opened(path);
    std::string text = "format = 1\n[source]\npath = \"gänge.bvh\"\n";
    ASSERT_TRUE(journal.add(EditCause::kOpen, text));
    first = journal.newest().sha256;
    for (int i = 0; i < 500; ++i) {
      text = gesture(text, dice);
      ASSERT_TRUE(journal.add(EditCause::kEdit, text));
    }
    last = journal.newest().sha256;
    EXPECT_EQ(last, recordings::sha256(text));
    while (journal.can_undo()) ASSERT_TRUE(journal.undo());
    EXPECT_EQ(journal.newest().sha256, first);
  }
  EditJournal journal = opened(path);  // A restart in between.
  EXPECT_EQ(journal.revision_count(), 1001);
  EXPECT_EQ(journal.newest().sha256, first);
  while (journal.can_redo()) ASSERT_TRUE(journal.redo());
  EXPECT_EQ(journal.newest().sha256, last);
  EXPECT_EQ(recordings::sha256(journal.newest_text()), last);
  EXPECT_EQ(journal.revision_count(), 1501);
}

TEST(EditJournal, MixedUndoAndRedoKeepAllRevisions) {
  const ScratchFolder folder;
  const fs::path path = folder.path() / "walk.edit.journal";
  GestureDice dice(11);
  std::vector<std::string> texts;
  {
    EditJournal journal = opened(path);
    std::vector<std::string> undone;  // An editor with two plain stacks.
    std::vector<std::string> done;
    std::string text = "start";
    ASSERT_TRUE(journal.add(EditCause::kOpen, text));
    texts.push_back(text);
    for (int i = 0; i < 300; ++i) {
      const std::size_t what = dice.below(3);
      if (what == 0 && journal.can_undo()) {
        ASSERT_TRUE(journal.undo());
        undone.push_back(text);
        text = done.back();
        done.pop_back();
      } else if (what == 1 && journal.can_redo()) {
        ASSERT_TRUE(journal.redo());
        done.push_back(text);
        text = undone.back();
        undone.pop_back();
      } else {
        done.push_back(text);
        undone.clear();
        text = gesture(text, dice);
        ASSERT_TRUE(journal.add(EditCause::kEdit, text));
      }
      ASSERT_EQ(journal.newest_text(), text);
      texts.push_back(text);
    }
  }
  const EditJournal journal = opened(path);
  ASSERT_EQ(journal.revision_count(), static_cast<int>(texts.size()));
  for (int i = 1; i <= journal.revision_count(); ++i) {
    EXPECT_EQ(journal.text(i), texts[static_cast<std::size_t>(i - 1)]);
  }
}

TEST(EditJournal, KeepsEveryRevisionOfAKilledProcess) {
  const ScratchFolder folder;
  const fs::path path = folder.path() / "walk.edit.journal";
  int reported[2]{};
  ASSERT_EQ(pipe(reported), 0);
  const pid_t child = fork();
  if (child == 0) {
    EditJournal journal = opened(path);
    bool ok = static_cast<bool>(journal.add(EditCause::kOpen, "start"));
    for (int i = 1; ok && i <= 100000; ++i) {
      ok = static_cast<bool>(
          journal.add(EditCause::kEdit, "revision " + std::to_string(i)));
      ok = ok && write(reported[1], &i, sizeof i) == sizeof i;
    }
    _exit(1);
  }
  close(reported[1]);
  int last = 0;
  for (int i = 0; i < 200; ++i) {
    ASSERT_EQ(read(reported[0], &last, sizeof last), static_cast<ssize_t>(sizeof last));
  }
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  while (read(reported[0], &last, sizeof last) == static_cast<ssize_t>(sizeof last)) {
  }
  close(reported[0]);
  const EditJournal journal = opened(path);
  // All that were reported; at most one more, which was not.
  EXPECT_GE(journal.revision_count(), last + 1);
  EXPECT_LE(journal.revision_count(), last + 2);
}

TEST(EditJournal, IgnoresATornLastLineAndContinuesWithoutIt) {
  const ScratchFolder folder;
  const fs::path path = folder.path() / "walk.edit.journal";
  {
    EditJournal journal = opened(path);
    ASSERT_TRUE(journal.add(EditCause::kOpen, "one"));
    ASSERT_TRUE(journal.add(EditCause::kEdit, "two"));
  }
  const std::string whole = content(path);
  const std::size_t second = whole.find('\n') + 1;
  for (std::size_t size = second; size < whole.size(); size += 7) {
    {
      std::ofstream(path, std::ios::binary) << whole.substr(0, size);
      EditJournal journal = opened(path);
      EXPECT_EQ(journal.newest_text(), "one");
      EXPECT_EQ(content(path).size(), size) << "reading changes nothing";
      ASSERT_TRUE(journal.add(EditCause::kEdit, "three"));
    }
    EXPECT_EQ(opened(path).newest_text(), "three");
  }
}

TEST(EditJournal, DeclinesADamagedLineWithItsNumber) {
  const ScratchFolder folder;
  const fs::path path = folder.path() / "walk.edit.journal";
  {
    EditJournal journal = opened(path);
    ASSERT_TRUE(journal.add(EditCause::kOpen, "the first text"));
    ASSERT_TRUE(journal.add(EditCause::kEdit, "the second text"));
    ASSERT_TRUE(journal.undo());
  }
  const std::string whole = content(path);
  std::vector<std::string> damaged;
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"second", "sekond"},
           {"\"of\":1", "\"of\":2"},
           {"\"of\":1", "\"of\":77"},
           {"\"keep\":4", "\"keep\":400"},
           {"\"revision\":2", "\"revision\":3"},
           {"\"parent\":1", "\"parent\":0"},
           {"\"edit\"", "\"open\""},
           {"\"undo\"", "\"redo\""},
           {"\"undo\"", "7"},
           {"\"journal\":1", "\"journal\":2"},
           {"{\"revision\":2", "[\"revision\":2"}}) {
    const std::size_t at = whole.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    damaged.push_back(whole);
    damaged.back().replace(at, from.size(), to);
  }
  damaged.push_back(whole + "\n");
  damaged.push_back(std::string(2000, '[') + "\n");
  for (const std::string& text : damaged) {
    std::ofstream(path, std::ios::binary) << text;
    const auto journal = EditJournal::open(path);
    ASSERT_FALSE(journal) << text;
    const std::string message = journal.error().message();
    EXPECT_NE(message.find("walk.edit.journal:"), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_EQ(content(path), text) << "the file stays as it is";
  }
}

TEST(EditJournal, DeclinesASecondOpener) {
  const ScratchFolder folder;
  const fs::path path = folder.path() / "walk.edit.journal";
  {
    EditJournal journal = opened(path);
    ASSERT_TRUE(journal.add(EditCause::kOpen, "one"));
    const auto second = EditJournal::open(path);
    ASSERT_FALSE(second);
    EXPECT_NE(second.error().message().find("is open in another marey"),
              std::string::npos);
    const pid_t child = fork();
    if (child == 0) _exit(EditJournal::open(path) ? 1 : 0);
    int status = 1;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0) << "another process is refused";
  }
  EXPECT_EQ(opened(path).newest_text(), "one");
}

TEST(EditJournal, DeclinesWhatIsNotAFile) {
  const ScratchFolder folder;
  EXPECT_FALSE(EditJournal::open(folder.path()));
  EXPECT_FALSE(EditJournal::open(folder.path() / "absent" / "walk.edit.journal"));
}

}  // namespace
}  // namespace marey::app
