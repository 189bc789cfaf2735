// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/clip_record_file.h"

#include <cstddef>
#include <optional>

#include "core/base/assert.h"
#include "recordings/base/nesting.h"
#include "recordings/base/sha256.h"
#include "recordings/library/clip_record_json.h"

namespace marey::recordings {
namespace {

/// Appends a part of a key with its size, so that parts cannot be confused.
void add_part(std::string& text, std::string_view part) {
  text += std::to_string(part.size());
  text += ':';
  text += part;
}

}  // namespace

std::string clip_record_text(const ClipRecord& record) {
  return clip_record_json(record).dump(
             1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) +
         "\n";
}

Result<ClipRecord> parse_clip_record(std::string_view text, const std::string& file) {
  constexpr const char* kBuildAgain = "build the library again: marey library build";
  if (json_nests_too_deep(text) || json_has_too_many_keys(text)) {
    return bad_input(file, "it is no record of a clip", kBuildAgain);
  }
  const auto root = nlohmann::ordered_json::parse(text, nullptr, false);
  if (root.is_discarded()) return bad_input(file, "it is not JSON", kBuildAgain);
  std::optional<Error> mistake;
  ClipRecord out = read_clip_record(root, file, mistake);
  if (mistake) return *mistake;
  return out;
}

std::string clip_id_of(const std::string& source_id,
                       const std::string& body,
                       int first_frame,
                       int last_frame) {
  constexpr std::size_t kDigits = 16;
  std::string text;
  add_part(text, source_id);
  add_part(text, body);
  add_part(text, std::to_string(first_frame));
  add_part(text, std::to_string(last_frame));
  return sha256(text).substr(0, kDigits);
}

std::string stage_key(const std::string& source_id,
                      std::string_view stage,
                      int version,
                      std::string_view options,
                      std::string_view before) {
  std::string text;
  add_part(text, source_id);
  add_part(text, stage);
  add_part(text, std::to_string(version));
  add_part(text, options);
  add_part(text, before);
  return sha256(text);
}

std::filesystem::path object_path(const std::string& key, std::string_view extension) {
  constexpr std::size_t kKeyDigits = 64;
  MAREY_ASSERT(key.size() == kKeyDigits);
  return std::filesystem::path("objects") / key.substr(0, 2) /
         (key.substr(2) + std::string(extension));
}

}  // namespace marey::recordings
