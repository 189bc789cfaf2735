// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/labels/import_labels.h"

#include <set>
#include <system_error>
#include <utility>

#include "app/library/labels/label_targets.h"
#include "core/base/extension.h"
#include "core/base/in_quotes.h"
#include "recordings/base/atomic_file.h"
#include "recordings/library/babel_file.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

/// Counts a row, and keeps its name if it is new.
class UnmatchedCounter {
 public:
  explicit UnmatchedCounter(UnmatchedNames& out) : out_(out) {}

  void add(const std::string& name) {
    ++out_.labels;
    if (known_.insert(name).second) out_.names.push_back(name);
  }

 private:
  UnmatchedNames& out_;
  std::set<std::string> known_;
};

/// Renames a file to the first name of FILE.1, FILE.2... that is free.
Result<fs::path> keep_backup(const fs::path& file) {
  constexpr int kMaxBackups = 1000;
  std::error_code failed;
  for (int i = 1; i <= kMaxBackups; ++i) {
    fs::path backup = file;
    backup += "." + std::to_string(i);
    if (fs::exists(backup, failed)) continue;
    // A link instead of renaming: at no instant is the table missing.
    fs::create_hard_link(file, backup, failed);
    if (failed) fs::copy_file(file, backup, failed);
    if (!failed) return backup;
    break;
  }
  return bad_input(file.string(),
                   "its former content cannot be kept next to it",
                   "free some space, or move the files " + file.filename().string() +
                       ".1, .2... to another place");
}

}  // namespace

Result<ImportedLabels> read_imported_labels(const fs::path& file, const std::string& by) {
  const std::string kind = kind_by_extension(file);
  ImportedLabels out;
  if (kind == ".csv") {
    const auto text = recordings::read_file(file);
    if (!text) return text.error();
    auto rows = recordings::parse_labels(*text, file.string(), by);
    if (!rows) return rows.error();
    out.rows = *std::move(rows);
  } else if (kind == ".json") {
    auto babel = recordings::read_babel(file, by);
    if (!babel) return babel.error();
    out.rows = std::move(babel->rows);
    out.left_out = babel->left_out;
  } else {
    return bad_input(
        file.string(),
        "it is neither a table of labels nor a file of BABEL",
        "give a .csv with the columns clip_or_source, start_s, end_s, label, "
        "by, sure, or BABEL's .json");
  }
  if (out.rows.empty()) {
    return bad_input(
        file.string(), "it has no labels", "check that it is the right file");
  }
  return out;
}

void match_imported_labels(std::span<const ClipRecord> records, ImportedLabels& labels) {
  const LabelTargets targets(records);
  UnmatchedCounter unknown(labels.unknown);
  UnmatchedCounter ambiguous(labels.ambiguous);
  std::vector<bool> has_label(records.size(), false);
  std::vector<recordings::LabelRow> kept;
  for (recordings::LabelRow& row : labels.rows) {
    const LabelTarget target = targets.find(row.target);
    if (target.is_found()) {
      for (const std::size_t clip : target.clips) has_label[clip] = true;
      row.target = target.name;
      kept.push_back(std::move(row));
    } else if (target.kind == LabelTarget::Kind::kAmbiguous) {
      ambiguous.add(row.target);
    } else {
      unknown.add(row.target);
    }
  }
  labels.rows = std::move(kept);
  for (const bool has : has_label) labels.clips += has ? 1 : 0;
}

Result<StoredTable> store_label_table(const fs::path& file,
                                      const std::string& text,
                                      bool may_replace) {
  StoredTable out;
  out.file = file;
  std::error_code failed;
  if (fs::exists(file, failed)) {
    const auto former = recordings::read_file(file);
    if (!former) return former.error();
    if (*former == text) {
      out.state = StoredTable::State::kUnchanged;
      return out;
    }
    if (!may_replace) {
      return bad_input(file.string(),
                       "the table exists with other labels",
                       "give another name with --by, or use --replace, which keeps the "
                       "former table next to it");
    }
    auto backup = keep_backup(file);
    if (!backup) return backup.error();
    out.backup = *std::move(backup);
    out.state = StoredTable::State::kReplaced;
  }
  const Status ok = recordings::write_file(file, text);
  if (!ok) return ok.error();
  return out;
}

}  // namespace marey::app
