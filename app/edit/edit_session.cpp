// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/edit/edit_session.h"

#include <algorithm>
#include <cstddef>
#include <system_error>
#include <utility>

#include "app/edit/edit_patch.h"
#include "app/edit/marker_edit_inputs.h"
#include "core/base/assert.h"
#include "recordings/base/atomic_file.h"
#include "recordings/edit/edit_recipe_file.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kEditEnding = ".edit";
constexpr std::size_t kSha256Digits = 64;

/// Returns "walk" for "walk.edit.toml", and for "walk.toml".
std::string recipe_stem(const fs::path& file) {
  std::string name = file.stem().string();
  if (name.ends_with(kEditEnding)) name.resize(name.size() - kEditEnding.size());
  return name;
}

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

/// Returns a recipe without operations.
EditRecipe new_recipe(const EditSessionOptions& options) {
  EditRecipe out;
  out.name = recipe_stem(options.recipe_file);
  std::error_code failed;
  const fs::path relative =
      fs::relative(options.source, folder_of(options.recipe_file), failed);
  EditSource source;
  source.path = failed || relative.empty() ? options.source.string() : relative.string();
  out.sources.push_back(std::move(source));
  return out;
}

/// Stores the SHA-256 of each source that has none, or of all.
/// Returns true if the recipe was changed.
bool record_sums(const EditFiles& files, bool all, EditRecipe& recipe) {
  bool is_changed = false;
  for (std::size_t i = 0; i < recipe.sources.size(); ++i) {
    std::string& sha256 = recipe.sources[i].sha256;
    // Sums of files that the source itself names follow its own.
    const std::string read = files.sha256[i].substr(0, kSha256Digits);
    if ((!sha256.empty() && !all) || sha256 == read) continue;
    sha256 = read;
    is_changed = true;
  }
  return is_changed;
}

std::vector<EditSourceFacts> facts_of(const EditRecipe& recipe, const EditFiles& files) {
  std::vector<EditSourceFacts> out;
  for (const EditSource& source : recipe.sources) {
    EditSourceFacts& facts = out.emplace_back();
    facts.id = source.id;
    facts.file = fs::path(source.path).filename().string();
    const auto state = files.inputs.sources.find(source.id);
    if (state == files.inputs.sources.end()) continue;
    facts.frames = state->second.frame_count();
    facts.rate_hz = state->second.motion.rate.hz;
  }
  return out;
}

ReadEditOptions read_options(const EditSessionOptions& options) {
  return {folder_of(options.recipe_file),
          options.recipe_file.string(),
          options.accept_new_sources};
}

bool is_new_recipe(const EditSessionOptions& options) {
  std::error_code failed;
  return !fs::exists(options.recipe_file, failed) && !options.source.empty();
}

Result<EditRecipe> recipe_of(const EditSessionOptions& options) {
  auto recipe = is_new_recipe(options)
                    ? Result<EditRecipe>(new_recipe(options))
                    : recordings::read_edit_recipe(options.recipe_file);
  if (recipe && recipe->name.empty()) recipe->name = recipe_stem(options.recipe_file);
  return recipe;
}

}  // namespace

fs::path journal_of(const fs::path& recipe_file) {
  return folder_of(recipe_file) / (recipe_stem(recipe_file) + ".edit.journal");
}

struct EditSession::Opened {
  std::string file_text;
  EditJournal journal;
  EditRecipe recipe;
  EditFiles files;
};

Result<std::unique_ptr<EditSession>> EditSession::open(const EditSessionOptions& options,
                                                       EditListener& listener) {
  auto recipe = recipe_of(options);
  if (!recipe) return recipe.error();
  if (edits_markers(*recipe, read_options(options))) {
    return bad_input(recipe->sources.front().path,
                     "labelled markers cannot be edited on the page",
                     "write the operations into a recipe (marey edit MARKERS --new "
                     "NAME.edit.toml), and apply it with --out");
  }
  auto files = read_edit_files(*recipe, read_options(options));
  if (!files) return files.error();
  auto journal = EditJournal::open(journal_of(options.recipe_file));
  if (!journal) return journal.error();
  // Another session may have ended since, whose last change is in the recipe.
  auto locked = recipe_of(options);
  if (!locked) return locked.error();
  if (recordings::edit_recipe_text(*locked) != recordings::edit_recipe_text(*recipe)) {
    recipe = std::move(locked);
    files = read_edit_files(*recipe, read_options(options));
    if (!files) return files.error();
  }
  const bool is_new = is_new_recipe(options);
  const bool sums = record_sums(*files, options.accept_new_sources, *recipe);
  const std::string text = recordings::edit_recipe_text(*recipe);
  if (journal->is_empty() || journal->newest_text() != text) {
    const auto cause = journal->is_empty() ? EditCause::kOpen : EditCause::kFile;
    if (const Status ok = journal->add(cause, text); !ok) return ok.error();
  }
  if (is_new || sums) {
    const Status ok = recordings::write_edit_recipe(options.recipe_file, *recipe);
    if (!ok) return ok.error();
  }
  // With the lines of its own text.
  auto own = recordings::parse_edit_recipe(text, options.recipe_file);
  if (!own) return own.error();
  auto file_text = recordings::read_file(options.recipe_file);
  if (!file_text) return file_text.error();
  Opened opened{
      *std::move(file_text), *std::move(journal), *std::move(own), *std::move(files)};
  return std::unique_ptr<EditSession>(
      new EditSession(std::move(opened), options, listener));
}

EditSession::EditSession(Opened opened,
                         const EditSessionOptions& options,
                         EditListener& listener)
    : recipe_file_(options.recipe_file),
      file_text_(std::move(opened.file_text)),
      journal_(std::move(opened.journal)),
      recipe_(std::move(opened.recipe)),
      avatars_(avatars_of(recipe_)),
      facts_(facts_of(recipe_, opened.files)),
      remarks_(opened.files.remarks),
      can_write_(!options.output.out.empty()),
      listener_(listener),
      worker_(std::move(opened.files),
              recipe_,
              read_options(options),
              options.output,
              listener) {
  listener_.on_revision(*this);
  worker_.render(revision().number, recipe_);
}

std::vector<EditSourceFacts> EditSession::sources() const {
  std::vector<EditSourceFacts> out;
  for (const EditSource& source : recipe_.sources) {
    const std::string file = fs::path(source.path).filename().string();
    const auto known = std::find_if(facts_.begin(), facts_.end(), [&](const auto& one) {
      return one.id == source.id && one.file == file;
    });
    out.push_back(known != facts_.end() ? *known
                                        : EditSourceFacts{source.id, file, 0, 0.0});
  }
  return out;
}

std::optional<EditOutcome> EditSession::check_base(int base_revision) const {
  if (base_revision == revision().number) return std::nullopt;
  return EditStale{revision().number};
}

/// Makes a revision of the recipe's file if another program has changed it. Then returns
/// the answer to the change that was requested.
std::optional<EditOutcome> EditSession::take_file() {
  auto text = recordings::read_file(recipe_file_);
  // A file that is gone is written again with the change.
  if (!text || *text == file_text_) return std::nullopt;
  auto recipe = recordings::parse_edit_recipe(*text, recipe_file_);
  if (!recipe) return recipe.error();
  file_text_ = *std::move(text);
  if (recipe->name.empty()) recipe->name = recipe_stem(recipe_file_);
  const std::string own_text = recordings::edit_recipe_text(*recipe);
  if (own_text == recipe_text()) return std::nullopt;
  auto own = recordings::parse_edit_recipe(own_text, recipe_file_);
  if (!own) return own.error();
  if (const Status ok = journal_.add(EditCause::kFile, own_text); !ok) return ok.error();
  recipe_ = *std::move(own);
  avatars_.merge(avatars_of(recipe_));
  listener_.on_revision(*this);
  worker_.render(revision().number, recipe_);
  return EditStale{revision().number};
}

/// Takes the recipe of the journal's newest revision, if that could be stored.
EditOutcome EditSession::adopt(EditRecipe recipe, const Status& stored) {
  if (!stored) return stored.error();
  recipe_ = std::move(recipe);
  avatars_.merge(avatars_of(recipe_));  // Largest size of recipes in the journal.
  listener_.on_revision(*this);
  worker_.render(revision().number, recipe_);
  const Status written = recordings::write_file(recipe_file_, recipe_text());
  if (!written) return written.error();
  file_text_ = recipe_text();
  return EditAccepted{revision().number};
}

EditOutcome EditSession::edit(const live::EditRequest& request) {
  if (auto answer = take_file()) return *answer;
  if (auto stale = check_base(request.base_revision)) return *stale;
  auto recipe = apply_patch(recipe_, request.patch, avatars_);
  if (!recipe) return recipe.error();
  const std::string text = recordings::edit_recipe_text(*recipe);
  const Status stored = journal_.add(EditCause::kEdit, text);
  return adopt(*std::move(recipe), stored);
}

EditOutcome EditSession::restore(const std::string& text, bool is_undo) {
  auto recipe = recordings::parse_edit_recipe(text, recipe_file_);
  if (!recipe) return recipe.error();
  const Status stored = is_undo ? journal_.undo() : journal_.redo();
  return adopt(*std::move(recipe), stored);
}

EditOutcome EditSession::undo(const live::UndoRequest& request) {
  if (auto answer = take_file()) return *answer;
  if (auto stale = check_base(request.base_revision)) return *stale;
  if (!can_undo()) {
    return bad_input("undo", "nothing is left to undo", "redo, or change the edit");
  }
  return restore(journal_.undo_text(), true);
}

EditOutcome EditSession::redo(const live::RedoRequest& request) {
  if (auto answer = take_file()) return *answer;
  if (auto stale = check_base(request.base_revision)) return *stale;
  if (!can_redo()) {
    return bad_input("redo", "nothing is left to redo", "undo, or change the edit");
  }
  return restore(journal_.redo_text(), false);
}

EditOutcome EditSession::preview(EditAsker asker, const live::PreviewRequest& request) {
  if (auto stale = check_base(request.base_revision)) return *stale;
  auto recipe = request.patch.empty() ? Result<EditRecipe>(recipe_)
                                      : apply_patch(recipe_, request.patch, avatars_);
  if (!recipe) return recipe.error();
  worker_.add(PreviewTask{std::move(asker),
                          revision().number,
                          *std::move(recipe),
                          {request.until, request.output, request.span}});
  return EditAccepted{revision().number};
}

EditOutcome EditSession::loops(EditAsker asker, const live::LoopsRequest& request) {
  if (auto stale = check_base(request.base_revision)) return *stale;
  LoopsTask task{std::move(asker),
                 revision().number,
                 recipe_,
                 request.until,
                 request.output,
                 {},
                 request.map};
  task.options.min_period_s = request.min_period_s;
  task.options.max_period_s = request.max_period_s;
  worker_.add(std::move(task));
  return EditAccepted{revision().number};
}

EditOutcome EditSession::jump(EditAsker asker, const live::JumpRequest& request) {
  if (auto stale = check_base(request.base_revision)) return *stale;
  auto recipe = request.patch.empty() ? Result<EditRecipe>(recipe_)
                                      : apply_patch(recipe_, request.patch, avatars_);
  if (!recipe) return recipe.error();
  worker_.add(JumpTask{std::move(asker),
                       revision().number,
                       *std::move(recipe),
                       request.op,
                       request.output});
  return EditAccepted{revision().number};
}

EditOutcome EditSession::write(EditAsker asker, const live::ExportRequest& request) {
  if (auto stale = check_base(request.base_revision)) return *stale;
  if (!can_write_) {
    return bad_input("export",
                     "this edit has no folder for results",
                     "start marey edit with --out FOLDER");
  }
  worker_.add(ExportTask{std::move(asker), revision().number, recipe_});
  return EditAccepted{revision().number};
}

}  // namespace marey::app
