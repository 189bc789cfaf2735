// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/base/other_kind.h"

#include <array>
#include <cstddef>

namespace marey::recordings {
namespace {

using std::string_view_literals::operator""sv;

struct Signature {
  std::size_t at;
  std::string_view bytes;
  std::string_view kind;
};

// The order matters: the last ones are those of whole families.
constexpr std::array kSignatures{
    Signature{0, "glTF"sv, kGltfKind},
    Signature{4, "ftyp"sv, "a video"},
    Signature{0, "\x1A\x45\xDF\xA3"sv, "a video"},
    Signature{8, "AVI "sv, "a video"},
    Signature{0, "HIERARCHY"sv, kBvhKind},
    Signature{0, ":ASF"sv, "an ASF skeleton"},
    Signature{0, "PathFileType"sv, kTrcKind},
    Signature{0, "SQLite format 3"sv, "an SQLite file, such as a recorded take"},
    Signature{0, "PK\x03\x04"sv, "a ZIP archive or an NPZ motion"},
    Signature{0, "%PDF"sv, "a PDF document"},
    Signature{0, "\x89PNG"sv, "a picture"},
    Signature{0, "\xFF\xD8\xFF"sv, "a picture"},
    Signature{0, "<"sv, "an XML or HTML file"},
    Signature{0, "{"sv, "a JSON file"},
    // Byte 2 of a C3D file is 0x50; byte 1 is the block of its parameters.
    Signature{1, "\x50"sv, kC3dKind},
};

bool is_c3d(std::string_view content) {
  return content.size() >= 512 && content[0] != '\0' && content[0] < '\t';
}

}  // namespace

std::string_view other_kind(std::string_view content) {
  if (content.starts_with("\xEF\xBB\xBF"sv)) content.remove_prefix(3);
  for (const Signature& signature : kSignatures) {
    if (content.size() < signature.at) continue;
    if (!content.substr(signature.at).starts_with(signature.bytes)) continue;
    if (signature.at == 1 && !is_c3d(content)) continue;
    return signature.kind;
  }
  // TOML has no null characters.
  const bool is_binary = content.substr(0, 512).find('\0') != std::string_view::npos;
  return is_binary ? kBinaryKind : ""sv;
}

Status check_kind(std::string_view content,
                  const std::string& file,
                  std::string_view wanted) {
  if (content.empty()) return empty_file(file);
  const std::string_view found = other_kind(content);
  if (found.empty() || found == wanted) return Done{};
  return bad_input(file,
                   std::string("this is ").append(found).append(", not ").append(wanted),
                   "give another file, or correct the extension of this one");
}

Error empty_file(const std::string& file) {
  return bad_input(file, "the file is empty", "copy or export it again");
}

}  // namespace marey::recordings
