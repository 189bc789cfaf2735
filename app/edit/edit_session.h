// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "app/edit/edit_events.h"
#include "app/edit/edit_inputs.h"
#include "app/edit/edit_journal.h"
#include "app/edit/edit_outputs.h"
#include "app/edit/edit_worker.h"
#include "core/base/result.h"
#include "core/edit/edit_recipe.h"
#include "live/page/edit_request.h"

namespace marey::app {

struct EditSessionOptions {
  /// The recipe (NAME.edit.toml). If it does not exist, it is made for `source`. Its
  /// journal NAME.edit.journal is next to it.
  std::filesystem::path recipe_file;
  std::filesystem::path source;  ///< Motion of a new recipe.
  EditOutput output;             ///< Folder and formats of an export.
  bool accept_new_sources = false;
};

/// Facts about a source, for the page.
struct EditSourceFacts {
  std::string id;
  std::string file;  ///< Without its folder.
  int frames = 0;
  double rate_hz = 0.0;
};

/// A change was made: the number of its revision.
struct EditAccepted {
  int revision = 0;
};
/// A change was made on a revision that is not the newest. Nothing was changed.
struct EditStale {
  int newest = 0;
};
using EditOutcome = std::variant<EditAccepted, EditStale, Error>;

/// The document behind the page of marey edit: its revisions, undo and redo, and its
/// rendering. Knows no network. Used by one thread; results arrive at the listener on
/// another one.
class EditSession {
 public:
  /// Opens or makes the recipe, reads its files, opens the journal, and starts to render.
  /// A recipe that differs from the journal's newest becomes a revision. A new recipe is
  /// written with the SHA-256 of its source. `listener` must outlive the session.
  /// Errors: those of read_edit_recipe(), read_edit_files(), EditJournal and the disk.
  [[nodiscard]] static Result<std::unique_ptr<EditSession>> open(
      const EditSessionOptions& options, EditListener& listener);

  [[nodiscard]] const EditRecipe& recipe() const { return recipe_; }
  [[nodiscard]] const EditRevision& revision() const { return journal_.newest(); }
  [[nodiscard]] const std::string& recipe_text() const { return journal_.newest_text(); }
  [[nodiscard]] const std::filesystem::path& recipe_file() const { return recipe_file_; }
  [[nodiscard]] bool can_undo() const { return journal_.can_undo(); }
  [[nodiscard]] bool can_redo() const { return journal_.can_redo(); }
  /// Values that a page may give for RetargetOp::avatar.
  [[nodiscard]] const std::set<std::string>& avatars() const { return avatars_; }
  [[nodiscard]] std::vector<EditSourceFacts> sources() const;
  /// Remarks of the readers of the files.
  [[nodiscard]] const std::vector<std::string>& remarks() const { return remarks_; }

  /// Makes a revision, stores it in the journal and in the recipe's file, and starts to
  /// render it. After an error nothing is changed, unless only the recipe's file could
  /// not be written: then the next revision writes it. A file that another program has
  /// changed becomes a revision first, so that the change is stale; it is not replaced
  /// if it cannot be read.
  [[nodiscard]] EditOutcome edit(const live::EditRequest& request);
  [[nodiscard]] EditOutcome undo(const live::UndoRequest& request);
  [[nodiscard]] EditOutcome redo(const live::RedoRequest& request);

  /// Starts a task for a page. Its result arrives at the listener. EditAccepted: it was
  /// started.
  [[nodiscard]] EditOutcome preview(EditAsker asker, const live::PreviewRequest& request);
  [[nodiscard]] EditOutcome loops(EditAsker asker, const live::LoopsRequest& request);
  [[nodiscard]] EditOutcome jump(EditAsker asker, const live::JumpRequest& request);
  [[nodiscard]] EditOutcome write(EditAsker asker, const live::ExportRequest& request);

  /// To be called several times a second: bounds the loss by a power cut to one second.
  [[nodiscard]] Status sync_if_due() { return journal_.sync_if_due(); }
  void wait_until_idle() { worker_.wait_until_idle(); }

 private:
  struct Opened;  // Everything that open() reads.
  EditSession(Opened opened, const EditSessionOptions& options, EditListener& listener);
  [[nodiscard]] std::optional<EditOutcome> check_base(int base_revision) const;
  [[nodiscard]] std::optional<EditOutcome> take_file();
  [[nodiscard]] EditOutcome adopt(EditRecipe recipe, const Status& stored);
  [[nodiscard]] EditOutcome restore(const std::string& text, bool is_undo);

  std::filesystem::path recipe_file_;
  std::string file_text_;  ///< The recipe's file when it was read or written last.
  EditJournal journal_;
  EditRecipe recipe_;
  std::set<std::string> avatars_;
  std::vector<EditSourceFacts> facts_;
  std::vector<std::string> remarks_;
  bool can_write_;  ///< There is a folder for exports.
  EditListener& listener_;
  EditWorker worker_;  ///< Last, because its thread ends first.
};

/// Returns the path of a recipe's journal: NAME.edit.journal for NAME.edit.toml.
[[nodiscard]] std::filesystem::path journal_of(const std::filesystem::path& recipe_file);

}  // namespace marey::app
