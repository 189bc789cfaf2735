// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/index_head.h"

#include "recordings/base/sqlite.h"
#include "recordings/library/library_paths.h"
#include "recordings/library/open_index.h"

namespace marey::recordings {

Result<IndexHead> read_index_head(const std::filesystem::path& path) {
  const auto database = open_index(path);
  if (!database) return database.error();
  Statement head(database->get(),
                 "SELECT version, version_name, search, inputs, clips, warned, failed, "
                 "duplicates, seconds, remarks, settings FROM head");
  if (!head.next_row()) return bad_index(path, "it has no head");
  IndexHead out;
  out.version = static_cast<int>(head.integer(0));
  out.version_name = head.text(1);
  out.search = head.text(2);
  out.inputs = head.text(3);
  out.clips = head.integer(4);
  out.warned = head.integer(5);
  out.failed = head.integer(6);
  out.duplicates = head.integer(7);
  out.seconds = head.number(8);
  out.remarks = head.text(9);
  out.settings = head.text(10);
  return out;
}

Status check_library_index(const std::filesystem::path& path) {
  const auto database = open_index(path);
  if (!database) return database.error();
  Statement check(database->get(), "PRAGMA quick_check(1)");
  if (check.next_row() && check.text(0) == "ok") return Done{};
  return bad_index(path, "it is damaged");
}

Result<std::filesystem::path> search_file(const std::filesystem::path& index,
                                          const std::string& name) {
  const auto head = read_index_head(index);
  if (!head) return head.error();
  // A name, not a path: a damaged index must not lead elsewhere.
  const std::filesystem::path folder = std::filesystem::path(head->search).filename();
  return LibraryPaths(index.parent_path()).search(folder.string()) / name;
}

}  // namespace marey::recordings
