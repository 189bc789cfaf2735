// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/base/content_key.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <xxhash.h>

#include "core/base/assert.h"
#include "core/base/input_file.h"
#include "core/base/name_pattern.h"

namespace marey::recordings {
namespace fs = std::filesystem;

namespace {

/// XXH3 with 128 bits over the bytes that are added.
class Hash {
 public:
  Hash() : state_(XXH3_createState(), XXH3_freeState) {
    MAREY_ASSERT(state_ != nullptr);
    XXH3_128bits_reset(state_.get());
  }

  void add(std::string_view bytes) {
    XXH3_128bits_update(state_.get(), bytes.data(), bytes.size());
  }

  [[nodiscard]] std::string hex() const {
    constexpr std::string_view kDigits = "0123456789abcdef";
    XXH128_canonical_t bytes{};
    XXH128_canonicalFromHash(&bytes, XXH3_128bits_digest(state_.get()));
    std::string text;
    for (const unsigned char byte : bytes.digest) {
      text += kDigits[byte >> 4U];
      text += kDigits[byte & 15U];
    }
    return text;
  }

 private:
  std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state_;
};

Error unreadable(const fs::path& path) {
  return bad_input(path.string(), "it cannot be read", "check the name and permissions");
}

Result<std::string> key_of_file(const fs::path& path) {
  if (const Status ok = check_input_file(path); !ok) return ok.error();
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return unreadable(path);
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  std::string piece(kPiece, '\0');
  std::uintmax_t size = 0;
  Hash hash;
  while (stream) {
    stream.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    const auto count = static_cast<std::size_t>(stream.gcount());
    hash.add(std::string_view(piece).substr(0, count));
    size += count;
  }
  if (stream.bad()) return unreadable(path);
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
  Hash hash;
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
