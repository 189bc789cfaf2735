// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/shell/inside_folder.h"

#include <algorithm>
#include <system_error>
#include <vector>

namespace marey::app {

namespace fs = std::filesystem;

bool is_inside(const fs::path& path, const fs::path& folder) {
  std::error_code problem;
  const fs::path real = fs::canonical(path, problem);
  if (problem) return false;
  const fs::path root = fs::canonical(folder, problem);
  if (problem) return false;
  return std::mismatch(root.begin(), root.end(), real.begin(), real.end()).first ==
         root.end();
}

Status check_link(const fs::path& file, const fs::path& root) {
  std::error_code ignored;
  if (!fs::is_symlink(file, ignored) || is_inside(file, root)) return Done{};
  return bad_input(file.string(),
                   "this link leads out of the folder of results, or to nothing",
                   "remove it, or put the file itself in its place");
}

Status check_links(const fs::path& folder, const fs::path& root) {
  std::vector<fs::path> links;
  std::error_code problem;
  for (fs::directory_iterator at(folder, problem), end; !problem && at != end;
       at.increment(problem)) {
    std::error_code ignored;
    if (at->is_symlink(ignored)) links.push_back(at->path());
  }
  // The order of a directory iteration is unspecified.
  std::ranges::sort(links);
  for (const fs::path& link : links) {
    if (const Status ok = check_link(link, root); !ok) return ok;
  }
  return Done{};
}

}  // namespace marey::app
