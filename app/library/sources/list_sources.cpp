// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/sources/list_sources.h"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include <fnmatch.h>

#include "core/base/extension.h"
#include "core/base/in_quotes.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

/// Motions of bodies. Markers and takes are solved first: by marey fit and process.
constexpr std::array<std::string_view, 7> kSourceKinds = {
    "bvh", "amc", "npz", "glb", "gltf", "vrm", "vrma"};

bool is_skipped(const LibrarySource& source, const std::string& name) {
  return std::ranges::any_of(source.skip, [&](const std::string& pattern) {
    return fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
  });
}

/// Collects the files of one source.
class SourceLister {
 public:
  SourceLister(const fs::path& library,
               const LibrarySource& source,
               std::size_t index,
               std::set<fs::path>& known,
               std::vector<SourceFile>& out)
      : library_(library), source_(source), index_(index), known_(known), out_(out) {}

  /// Returns the number of files that the source has, known ones included.
  std::size_t list() {
    const fs::path stated(source_.path);
    const fs::path root = stated.is_absolute() ? stated : library_ / stated;
    std::error_code failed;
    if (fs::is_regular_file(root, failed)) return add(root) ? 1 : 0;
    std::size_t count = 0;
    const auto options = fs::directory_options::skip_permission_denied;
    for (fs::recursive_directory_iterator at(root, options, failed), end;
         !failed && at != end;
         at.increment(failed)) {
      const std::string name = at->path().filename().string();
      if (name.starts_with('.')) {
        at.disable_recursion_pending();
        continue;
      }
      std::error_code unknown;
      if (at->is_regular_file(unknown) && add(at->path())) ++count;
    }
    return count;
  }

 private:
  bool add(const fs::path& path) {
    std::string kind = lower_extension(path);
    const bool is_read =
        std::ranges::find(kSourceKinds, std::string_view(kind)) != kSourceKinds.end();
    if (!is_read || (!source_.kind.empty() && kind != source_.kind)) return false;
    std::error_code failed;
    const fs::path full = fs::weakly_canonical(path, failed);
    const fs::path below =
        full.lexically_relative(fs::weakly_canonical(library_, failed));
    const bool is_below = !below.empty() && !below.string().starts_with("..");
    const std::string name = (is_below ? below : full).generic_string();
    if (is_skipped(source_, name)) return false;
    if (!known_.insert(full).second) return true;
    out_.push_back({path, name, std::move(kind), index_, fs::file_size(path, failed)});
    return true;
  }

  static std::string lower_extension(const fs::path& path) {
    std::string kind = kind_by_extension(path);
    if (kind.starts_with('.')) kind.erase(0, 1);
    return kind;
  }

  const fs::path& library_;
  const LibrarySource& source_;
  std::size_t index_;
  std::set<fs::path>& known_;
  std::vector<SourceFile>& out_;
};

}  // namespace

std::string source_kinds() {
  std::string out;
  for (const std::string_view kind : kSourceKinds) {
    out += (out.empty() ? "." : ", .") + std::string(kind);
  }
  return out;
}

Result<std::vector<SourceFile>> list_sources(const fs::path& library,
                                             const LibrarySettings& settings) {
  std::vector<SourceFile> out;
  std::set<fs::path> known;
  for (std::size_t i = 0; i < settings.sources.size(); ++i) {
    const LibrarySource& source = settings.sources[i];
    const auto at_source = [&](std::string cause, std::string next) {
      return bad_input(
          (library / "library.toml").string() + ":" + std::to_string(source.line),
          std::move(cause),
          std::move(next));
    };
    const fs::path stated(source.path);
    std::error_code failed;
    if (!fs::exists(stated.is_absolute() ? stated : library / stated, failed)) {
      return at_source("the source " + in_quotes(source.path) + " does not exist",
                       "correct the path; it is relative to the library");
    }
    if (SourceLister(library, source, i, known, out).list() == 0) {
      return at_source("the source " + in_quotes(source.path) +
                           " has no file that a "
                           "library reads",
                       "give files of the kinds " + source_kinds());
    }
  }
  std::ranges::sort(out, {}, &SourceFile::name);
  return out;
}

std::vector<std::pair<std::string, std::string>> words_in_name(
    const std::string& name, const std::string& pattern) {
  std::vector<std::pair<std::string, std::string>> out;
  std::size_t at = 0;
  for (std::size_t i = 0; i < pattern.size();) {
    const bool is_word = pattern[i] == '{';
    if (!is_word && pattern[i] != '*') {
      if (at >= name.size() || name[at] != pattern[i]) return {};
      ++at;
      ++i;
      continue;
    }
    const std::size_t close = is_word ? pattern.find('}', i) : i;
    if (close == std::string::npos) return {};
    const std::size_t next = close + 1;
    const std::size_t until = std::min(pattern.find_first_of("{*", next), pattern.size());
    const std::string after = pattern.substr(next, until - next);
    const std::size_t end = after.empty() ? name.size() : name.find(after, at);
    if (end == std::string::npos) return {};
    if (is_word) {
      out.emplace_back(pattern.substr(i + 1, close - i - 1), name.substr(at, end - at));
    }
    at = end;
    i = next;
  }
  return at == name.size() ? out : std::vector<std::pair<std::string, std::string>>{};
}

}  // namespace marey::app
