// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/page/page_corrections.h"

#include <cmath>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "app/shell/inside_folder.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/folder_lock.h"
#include "recordings/library/label_file.h"
#include "recordings/library/verdict_file.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

static_assert(std::string_view(kVerdictTable).ends_with(recordings::kVerdictFile));
static_assert(std::string_view(kLabelTable).ends_with(recordings::kPageLabelFile));

/// Creates the folder of a table. Checks that the table is stored in the library itself.
Status prepare_table(const fs::path& library, const fs::path& table) {
  std::error_code ignored;  // Writing reports it.
  fs::create_directories(table.parent_path(), ignored);
  if (const Status ok = check_link(table.parent_path(), library); !ok) return ok;
  return check_link(table, library);
}

double rounded_s(double seconds) {
  return std::round(1000.0 * seconds) / 1000.0;
}

}  // namespace

Status store_verdict(const fs::path& library,
                     const live::LibraryVerdictRequest& verdict) {
  const fs::path table = library / kVerdictTable;
  if (const Status ok = prepare_table(library, table); !ok) return ok;
  const auto lock = recordings::FolderLock::take(table.parent_path());
  if (!lock) return lock.error();
  recordings::VerdictCorrection row;
  row.clip = verdict.clip_id;
  row.figure = verdict.figure;
  row.frames = verdict.frames;
  row.verdict = verdict.verdict;
  row.by = verdict.by;
  row.note = verdict.note;
  return recordings::add_verdict(table, std::move(row));
}

Status store_label(const fs::path& library, const live::LibraryLabelRequest& label) {
  const fs::path table = library / kLabelTable;
  if (const Status ok = prepare_table(library, table); !ok) return ok;
  if (label.by == "marey") {
    return bad_input("label",
                     "\"marey\" is the name of labels that a build makes",
                     "write your own name");
  }
  const auto lock = recordings::FolderLock::take(table.parent_path());
  if (!lock) return lock.error();
  std::vector<recordings::LabelRow> rows;
  std::error_code ignored;
  if (fs::exists(table, ignored)) {
    auto read = recordings::read_labels(table);
    if (!read) return read.error();
    rows = *std::move(read);
  }
  recordings::LabelRow& row = rows.emplace_back();
  row.target = label.clip_id;
  row.start_s = rounded_s(label.start_s);
  row.end_s = rounded_s(label.end_s);
  row.text = label.label;
  row.by = label.by;
  row.certainty = label.is_sure ? 1.0 : 0.5;
  return recordings::write_file(table, recordings::labels_text(rows));
}

}  // namespace marey::app
