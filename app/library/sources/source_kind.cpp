// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/sources/source_kind.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>

#include "core/base/extension.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

/// Extensions of motions and of labelled markers.
constexpr std::array<std::string_view, 9> kSourceExtensions = {
    "bvh", "amc", "npz", "glb", "gltf", "vrm", "vrma", "c3d", "trc"};

constexpr std::string_view kRecipeEnding = ".edit.toml";

}  // namespace

std::string source_kind(const fs::path& path) {
  std::error_code failed;
  if (fs::is_directory(path, failed)) {
    return fs::is_regular_file(path / kSessionFile, failed) ? kSessionKind : "";
  }
  const std::string file = path.filename().string();
  if (file == kSessionFile) return kSessionKind;
  if (file.size() > kRecipeEnding.size() && file.ends_with(kRecipeEnding)) {
    return kRecipeKind;
  }
  std::string kind = kind_by_extension(path);
  if (kind.starts_with('.')) kind.erase(0, 1);
  const bool is_read = std::ranges::find(kSourceExtensions, std::string_view(kind)) !=
                       kSourceExtensions.end();
  return is_read ? kind : "";
}

std::string source_stem(const std::string& name, const std::string& kind) {
  const fs::path file = fs::path(name).filename();
  if (kind == kSessionKind) return file.string();
  if (kind == kRecipeKind) return file.stem().stem().string();
  return file.stem().string();
}

bool is_companion_file(const fs::path& path) {
  const std::string file = path.filename().string();
  const std::string extension = kind_by_extension(path);
  return extension == ".asf" || extension == ".bin" || file.ends_with(".bones.toml") ||
         file == kMarkerSubjectFile || file == kMarkerMapFile;
}

bool is_source_kind(const std::string& word) {
  return word == kSessionKind || word == kRecipeKind ||
         std::ranges::find(kSourceExtensions, std::string_view(word)) !=
             kSourceExtensions.end();
}

std::string source_kinds() {
  std::string out;
  for (const std::string_view kind : kSourceExtensions) {
    out += "." + std::string(kind) + ", ";
  }
  return out + std::string(kRecipeEnding) + " and folders with " + kSessionFile;
}

}  // namespace marey::app
