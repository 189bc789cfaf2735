// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/text/content_key.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/input_file.h"
#include "core/base/name_pattern.h"

namespace marey::recordings {
namespace fs = std::filesystem;

namespace {

/// FNV-1a, 64 bits (Fowler, Noll, Vo; offset basis and prime of IETF
/// draft-eastlake-fnv).
class Fnv {
 public:
  void add(std::string_view bytes) {
    for (const char byte : bytes) {
      hash_ = (hash_ ^ static_cast<unsigned char>(byte)) * 0x100000001b3ULL;
    }
  }

  [[nodiscard]] std::string hex() const {
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string text;
    for (int shift = 60; shift >= 0; shift -= 4) text += kDigits[(hash_ >> shift) & 15U];
    return text;
  }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325ULL;
};

Error unreadable(const fs::path& path) {
  return bad_input(path.string(), "it cannot be read", "check the name and permissions");
}

Result<std::string> key_of_file(const fs::path& path) {
  if (const Status ok = check_input_file(path); !ok) return ok.error();
  std::error_code problem;
  const std::uintmax_t size = fs::file_size(path, problem);
  std::ifstream stream(path, std::ios::binary);
  if (problem || !stream) return unreadable(path);
  constexpr std::uintmax_t kPiece = std::uintmax_t{1} << 20;
  std::string piece(static_cast<std::size_t>(std::min(size, kPiece)), '\0');
  Fnv hash;
  for (const std::uintmax_t start : {std::uintmax_t{0}, size - piece.size()}) {
    stream.seekg(static_cast<std::streamoff>(start));
    stream.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    if (!stream) return unreadable(path);
    hash.add(piece);
  }
  return std::to_string(size) + "-" + hash.hex();
}

Result<std::string> key_of_folder(const fs::path& path) {
  std::vector<std::pair<std::string, std::string>> files;
  std::error_code problem;
  for (fs::directory_iterator at(path, problem), end; !problem && at != end;
       at.increment(problem)) {
    std::error_code ignored;
    if (!at->is_regular_file(ignored)) continue;
    // An unreadable file is not part of the recording; otherwise reading it reports the
    // error.
    const Result<std::string> key = key_of_file(at->path());
    files.emplace_back(at->path().filename().string(), key ? *key : "unreadable");
  }
  if (problem) return unreadable(path);
  std::sort(files.begin(), files.end());  // Folders list their files in any order.
  Fnv hash;
  for (const auto& [name, key] : files) {
    hash.add(name);
    // Cannot be part of a name: "a1" 2 differs from "a" 12.
    hash.add(std::string_view("\0", 1));
    hash.add(key + "\n");
  }
  return std::to_string(files.size()) + "-" + hash.hex();
}

}  // namespace

Result<std::string> content_key(const fs::path& path) {
  std::error_code ignored;
  // For a pattern, the key covers the whole folder: too many changes do no harm.
  if (is_name_pattern(path)) return key_of_folder(path.parent_path());
  return fs::is_directory(path, ignored) ? key_of_folder(path) : key_of_file(path);
}

}  // namespace marey::recordings
