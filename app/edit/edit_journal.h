// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "recordings/base/line_journal.h"

namespace marey::app {

/// Origin of a revision.
enum class EditCause { kOpen, kEdit, kUndo, kRedo, kFile };
/// Returns the word in the journal: "open".
[[nodiscard]] std::string_view name(EditCause cause);

/// One state of a recipe.
struct EditRevision {
  int number = 1;
  int parent = 0;  ///< 0: none.
  EditCause cause = EditCause::kOpen;
  std::string sha256;  ///< SHA-256 of the recipe's text.
  std::string time;    ///< "2025-03-01T12:00:00Z".
};

/// All revisions of a recipe, in a file that is only appended to (NAME.edit.journal,
/// docs/formats/edit_page.md). Undo and redo add revisions, so that nothing is lost.
/// Used by one thread at a time.
class EditJournal {
 public:
  /// Opens or creates the journal. Errors: LineJournal::open()'s; (kBadInput) a line that
  /// is damaged or does not follow from those before it, with its number.
  [[nodiscard]] static Result<EditJournal> open(const std::filesystem::path& path);

  [[nodiscard]] bool is_empty() const { return entries_.empty(); }
  [[nodiscard]] int revision_count() const { return static_cast<int>(entries_.size()); }
  /// Precondition: 1 <= number <= revision_count().
  [[nodiscard]] const EditRevision& revision(int number) const;
  /// Returns the recipe's text in a revision. Precondition: as above.
  [[nodiscard]] const std::string& text(int number) const;
  /// Precondition: not empty.
  [[nodiscard]] const EditRevision& newest() const { return revision(revision_count()); }
  [[nodiscard]] const std::string& newest_text() const { return text(revision_count()); }

  [[nodiscard]] bool can_undo() const { return !undo_.empty(); }
  [[nodiscard]] bool can_redo() const { return !redo_.empty(); }
  /// Returns the text that undo() restores. Precondition: can_undo().
  [[nodiscard]] const std::string& undo_text() const { return text(undo_.back()); }
  /// Precondition: can_redo().
  [[nodiscard]] const std::string& redo_text() const { return text(redo_.back()); }

  /// Adds a revision. The first is kOpen, others are kEdit or kFile. After an error the
  /// journal is as before. Errors: LineJournal::append()'s. Precondition: UTF-8.
  [[nodiscard]] Status add(EditCause cause, std::string_view text);
  /// Adds a revision with the text before the last change that is not undone.
  /// Precondition: can_undo().
  [[nodiscard]] Status undo();
  /// Adds a revision with the text before the last undo. Precondition: can_redo().
  [[nodiscard]] Status redo();

  /// Writes revisions to the disk that have waited for half a second. Called several
  /// times a second, it bounds the loss by a power cut to one second.
  [[nodiscard]] Status sync_if_due() {
    return lines_.sync_older_than(std::chrono::milliseconds(500));
  }
  [[nodiscard]] Status sync() { return lines_.sync(); }

 private:
  struct Entry {
    EditRevision revision;
    std::string text;       ///< Empty if `of` is set.
    std::optional<int> of;  ///< Earlier revision with the same text.
  };

  explicit EditJournal(recordings::LineJournal lines) : lines_(std::move(lines)) {}
  [[nodiscard]] std::optional<std::string> read_line(const std::string& line);
  [[nodiscard]] Status append(Entry entry, const std::string& text);
  [[nodiscard]] bool follows(const Entry& entry) const;
  void take(Entry entry);

  recordings::LineJournal lines_;
  std::vector<Entry> entries_;
  std::vector<int> undo_;  ///< Revisions with texts of their own, the next to undo last.
  std::vector<int> redo_;
  int content_ = 0;  ///< Revision that holds the newest text.
};

}  // namespace marey::app
