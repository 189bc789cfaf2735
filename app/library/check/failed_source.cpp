// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/check/failed_source.h"

#include <algorithm>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/base/printable.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/table_cells.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxReasonBytes = 4000;

/// Appends a line to a text, after a blank.
void add_line(std::string& text, std::string_view line) {
  if (!text.empty()) text += ' ';
  text += printable(line);
}

/// Removes the full stop at the end.
std::string without_stop(std::string text) {
  if (text.ends_with('.')) text.pop_back();
  return text;
}

/// Reads "WHERE", "Cause: CAUSE." and "Next: NEXT.", each a line.
FailedSource failed_source(std::string name, std::string_view text) {
  constexpr std::string_view kCause = "Cause: ";
  constexpr std::string_view kNext = "Next: ";
  FailedSource out;
  out.source = std::move(name);
  recordings::LineReader lines(text.substr(0, kMaxReasonBytes));
  std::string* part = &out.where;
  while (const auto line = lines.next()) {
    std::string_view rest = recordings::trimmed(*line);
    if (rest.starts_with(kCause)) {
      part = &out.cause;
      rest.remove_prefix(kCause.size());
    } else if (rest.starts_with(kNext)) {
      part = &out.next;
      rest.remove_prefix(kNext.size());
    }
    if (!rest.empty()) add_line(*part, rest);
  }
  // Names of files below failed/ have no slash at their beginning.
  if (out.where.starts_with("/" + out.source)) out.source.insert(0, "/");
  if (out.cause.empty()) std::swap(out.cause, out.where);
  out.cause = without_stop(std::move(out.cause));
  out.next = without_stop(std::move(out.next));
  return out;
}

}  // namespace

Result<std::vector<FailedSource>> read_failed_sources(const fs::path& library) {
  const fs::path folder = library / "failed";
  std::vector<FailedSource> out;
  std::error_code failed;
  for (fs::recursive_directory_iterator at(folder, failed), end; !failed && at != end;
       at.increment(failed)) {
    std::error_code unknown;
    const bool is_reason =
        at->is_regular_file(unknown) && at->path().extension() == ".txt";
    if (!is_reason) continue;
    const auto text = recordings::read_file(at->path());
    if (!text) return text.error();
    const fs::path below = at->path().lexically_relative(folder);
    out.push_back(failed_source(
        printable((below.parent_path() / below.stem()).generic_string()), *text));
  }
  std::ranges::sort(out, {}, &FailedSource::source);
  return out;
}

}  // namespace marey::app
