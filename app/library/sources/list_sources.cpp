// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/sources/list_sources.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include <fnmatch.h>
#include <unistd.h>

#include "app/library/sources/source_kind.h"
#include "core/base/extension.h"
#include "core/base/in_quotes.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLibraryFile = "library.toml";

/// Folders next to library.toml that a build writes.
constexpr std::array<std::string_view, 5> kBuiltFolders = {
    "objects", "failed", "search", "versions", "shards"};

constexpr std::string_view kSubjectWord = "subject";

bool is_skipped(const LibrarySource& source, const std::string& name) {
  return std::ranges::any_of(source.skip, [&](const std::string& pattern) {
    return fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
  });
}

bool is_built_folder(const fs::path& folder) {
  const std::string name = folder.filename().string();
  std::error_code failed;
  return std::ranges::find(kBuiltFolders, std::string_view(name)) !=
             kBuiltFolders.end() &&
         fs::exists(folder.parent_path() / kLibraryFile, failed);
}

/// Returns the path of `full` below the folder `above`; nullopt: it is not below it.
std::optional<fs::path> path_below(const fs::path& full, const fs::path& above) {
  const fs::path below = full.lexically_relative(above);
  if (below.empty() || *below.begin() == "..") return std::nullopt;
  return below;
}

/// Returns true for a folder that this user may not read.
bool is_closed_folder(const fs::path& path) {
  std::error_code failed;
  return fs::is_directory(path, failed) && ::access(path.c_str(), R_OK | X_OK) != 0 &&
         errno == EACCES;
}

std::uintmax_t bytes_below(const fs::path& folder) {
  std::uintmax_t sum = 0;
  std::error_code failed;
  const auto options = fs::directory_options::skip_permission_denied;
  for (fs::recursive_directory_iterator at(folder, options, failed), end;
       !failed && at != end;
       at.increment(failed)) {
    std::error_code unknown;
    if (!at->is_regular_file(unknown)) continue;
    const std::uintmax_t size = at->file_size(unknown);
    if (!unknown) sum += size;
  }
  return sum;
}

/// Collects the files of one source.
class SourceLister {
 public:
  SourceLister(const fs::path& library,
               const std::vector<LibrarySource>& sources,
               std::size_t index,
               std::map<fs::path, std::size_t>& known,
               SourceListing& out)
      : library_(library),
        sources_(sources),
        source_(sources[index]),
        index_(index),
        known_(known),
        out_(out) {}

  /// Returns the number of files that the source has, known ones included.
  Result<std::size_t> list(const fs::path& root) {
    std::error_code failed;
    if (!fs::is_directory(root, failed)) return add_file(root) ? 1 : 0;
    if (add_session(root)) return 1;
    std::size_t count = 0;
    fs::path last = root;
    const auto options = fs::directory_options::skip_permission_denied;
    for (fs::recursive_directory_iterator at(root, options, failed), end;
         !failed && at != end;
         at.increment(failed)) {
      last = at->path();
      std::error_code unknown;
      const bool is_folder = at->is_directory(unknown);
      if (last.filename().string().starts_with('.') ||
          (is_folder && is_built_folder(last))) {
        at.disable_recursion_pending();
      } else if (is_folder && is_closed_folder(last)) {
        out_.closed_folders.insert(name_of(last));
        at.disable_recursion_pending();
      } else if (is_folder && add_session(last)) {
        at.disable_recursion_pending();
        ++count;
      } else if (at->is_regular_file(unknown) && add_file(last)) {
        ++count;
      }
    }
    if (!failed) return count;
    return Error{Errc::kDevice,
                 last.string(),
                 "the folder cannot be listed: " + failed.message(),
                 "check the disk and the connection to it, then build again"};
  }

 private:
  [[nodiscard]] bool is_wanted(const std::string& kind) const {
    return !kind.empty() && (source_.kind.empty() || kind == source_.kind);
  }

  bool add_session(const fs::path& folder) {
    if (!is_wanted(kSessionKind) || source_kind(folder) != kSessionKind) return false;
    return add(folder, kSessionKind);
  }

  bool add_file(const fs::path& path) {
    const std::string kind = source_kind(path);
    if (kind.empty()) {
      const bool is_ours =
          is_companion_file(path) || path.filename().string() == kLibraryFile;
      if (!is_ours) ++out_.left_out[kind_by_extension(path)];
      return false;
    }
    if (!is_wanted(kind)) return false;
    // A session is its folder, as trials lie next to session.toml.
    if (kind != kSessionKind) return add(path, kind);
    return add(path.has_parent_path() ? path.parent_path() : fs::path("."), kind);
  }

  /// Returns the path relative to the library if it is below it, else the full path.
  [[nodiscard]] std::string name_of(const fs::path& path) const {
    std::error_code failed;
    const fs::path full = fs::weakly_canonical(path, failed);
    const auto below = path_below(full, fs::weakly_canonical(library_, failed));
    return below.value_or(full).generic_string();
  }

  bool add(const fs::path& path, const std::string& kind) {
    std::error_code failed;
    const fs::path full = fs::weakly_canonical(path, failed);
    const std::string name = name_of(path);
    if (is_skipped(source_, name)) return false;
    const auto [place, is_new] = known_.emplace(full, index_);
    if (!is_new) {
      compare_licences(name, place->second);
      return true;
    }
    const std::uintmax_t bytes =
        kind == kSessionKind ? bytes_below(path) : fs::file_size(path, failed);
    out_.files.push_back({path, name, kind, index_, failed ? 0 : bytes});
    return true;
  }

  /// Adds a remark if this source has another licence than an earlier one of the file.
  void compare_licences(const std::string& name, std::size_t earlier) {
    if (is_compared_ || sources_[earlier].licence == source_.licence) return;
    is_compared_ = true;
    out_.remarks.push_back(
        name + " belongs to the sources " + in_quotes(sources_[earlier].path) + " and " +
        in_quotes(source_.path) + ", whose licences differ; the first one counts");
  }

  const fs::path& library_;
  const std::vector<LibrarySource>& sources_;
  const LibrarySource& source_;
  std::size_t index_;
  std::map<fs::path, std::size_t>& known_;
  SourceListing& out_;
  bool is_compared_ = false;
};

/// Returns the words of a pattern in a file's name, with or without its extension.
std::vector<std::pair<std::string, std::string>> words_of_file(
    const SourceFile& file, const std::string& pattern) {
  if (pattern.empty()) return {};
  auto words = words_in_name(source_stem(file.name, file.kind), pattern);
  if (!words.empty()) return words;
  return words_in_name(fs::path(file.name).filename().string(), pattern);
}

/// Returns true if `root` is in a folder of the library that its build writes.
bool is_in_own_folder(const fs::path& library, const fs::path& root) {
  std::error_code failed;
  const auto below = path_below(fs::weakly_canonical(root, failed),
                                fs::weakly_canonical(library, failed));
  return below && std::ranges::find(kBuiltFolders, below->begin()->string()) !=
                      kBuiltFolders.end();
}

}  // namespace

std::string SourceListing::left_out_text() const {
  std::size_t count = 0;
  std::string kinds;
  for (const auto& [extension, number] : left_out) {
    count += number;
    kinds += (kinds.empty() ? "" : ", ") + std::to_string(number) + " " +
             (extension.empty() ? "without extension" : extension);
  }
  std::string out;
  if (count > 0) {
    const bool is_one = count == 1;
    out = std::to_string(count) +
          (is_one ? " file of another kind was" : " files of other kinds were") +
          " left out: " + kinds;
  }
  if (closed_folders.empty()) return out;
  const bool is_one = closed_folders.size() == 1;
  return out + (out.empty() ? "" : "; ") + std::to_string(closed_folders.size()) +
         (is_one ? " folder without permission was left out: "
                 : " folders without permission were left out, the first is ") +
         *closed_folders.begin();
}

Result<SourceListing> list_sources(const fs::path& library,
                                   const LibrarySettings& settings) {
  SourceListing out;
  std::map<fs::path, std::size_t> known;
  for (std::size_t i = 0; i < settings.sources.size(); ++i) {
    const LibrarySource& source = settings.sources[i];
    const auto at_source = [&](std::string cause, std::string next) {
      return bad_input(
          (library / kLibraryFile).string() + ":" + std::to_string(source.line),
          "the source " + in_quotes(source.path) + " " + std::move(cause),
          std::move(next));
    };
    const fs::path stated(source.path);
    const fs::path root = stated.is_absolute() ? stated : library / stated;
    std::error_code failed;
    if (!fs::exists(root, failed)) {
      return at_source("does not exist",
                       "correct the path; it is relative to the library");
    }
    if (!source.kind.empty() && !is_source_kind(source.kind)) {
      return at_source("has the unknown kind " + in_quotes(source.kind),
                       "state one of bvh, amc, npz, glb, gltf, vrm, vrma, c3d, trc, "
                       "recipe and session, or remove `kind`");
    }
    if (is_in_own_folder(library, root)) {
      return at_source("is a part of the library that its build writes",
                       "name the files that these motions were made from");
    }
    if (is_closed_folder(root)) {
      return at_source("is a folder without permission",
                       "give yourself the right to read it, or remove the source");
    }
    const auto count = SourceLister(library, settings.sources, i, known, out).list(root);
    if (!count) return count.error();
    if (*count == 0) {
      return at_source("has no file that a library reads",
                       "give files of the kinds " + source_kinds());
    }
  }
  std::ranges::sort(out.files, {}, &SourceFile::name);
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

std::string subject_of(const SourceFile& file, const LibrarySource& source) {
  const bool is_pattern = source.subject.find('{') != std::string::npos;
  if (!source.subject.empty() && !is_pattern) return source.subject;
  const std::string& pattern = is_pattern ? source.subject : source.pattern;
  for (const auto& [word, value] : words_of_file(file, pattern)) {
    if (word == kSubjectWord) return value;
  }
  return {};
}

std::vector<ClipLabel> labels_of_name(const SourceFile& file,
                                      const LibrarySource& source,
                                      double duration_s) {
  std::vector<ClipLabel> out;
  for (const auto& [word, value] : words_of_file(file, source.pattern)) {
    if (word == kSubjectWord || value.empty()) continue;
    out.push_back({0.0, duration_s, word + ":" + value, "name", 1.0});
  }
  std::ranges::sort(out, {}, &ClipLabel::text);
  return out;
}

}  // namespace marey::app
