// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/base/toml_kind.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/assert.h"
#include "recordings/base/other_kind.h"

namespace marey::recordings {
namespace {

struct KindKeys {
  TomlKind kind;
  std::string_view name;  ///< For messages.
  /// Keys of which one is enough.
  std::initializer_list<std::string_view> keys;
  /// Other keys of this kind that files of another kind may be recognized by.
  std::initializer_list<std::string_view> shared = {};
};

/// The most specific kinds first. Calibrations have names of cameras as keys.
const std::array<KindKeys, 11>& kinds_of_toml() {
  static const std::array<KindKeys, 11> kKinds{
      {{TomlKind::kCalibration, "a calibration", {}},
       {TomlKind::kSession,
        "a session",
        {"trial", "board", "wand", "media", "tags"},
        {"camera"}},
       {TomlKind::kEditRecipe, "a recipe of edits", {"source", "op"}, {"limits"}},
       {TomlKind::kScene,
        "a scene",
        {"body", "group", "at", "measure", "duration_s"},
        {"base", "floor", "target", "out"}},
       {TomlKind::kTrials, "a list of trials", {"throw"}, {"order"}},
       {TomlKind::kSubject, "a subject", {"tips", "joint"}, {"tag"}},
       {TomlKind::kCharacter,
        "a character",
        {"avatar", "mass_table", "segment_mass_kg", "limits", "load", "subject"}},
       {TomlKind::kFloor, "a floor", {"base_m", "part"}},
       {TomlKind::kMarkerMap, "a map of marker labels", {"markers"}},
       {TomlKind::kBoneMap, "a bone map", {"bones", "unit_m", "front"}},
       {TomlKind::kPlan, "a plan", {"volume", "tag_size_m", "camera", "tag"}}}};
  return kKinds;
}

bool has_lens(TomlDocument& document) {
  TomlReader root(document);
  const std::vector<std::string> keys = root.keys();
  return std::any_of(keys.begin(), keys.end(), [&](const std::string& key) {
    return root.is_table(key) && (key == "cameras" || root.table(key).has("matrix"));
  });
}

std::size_t count_keys(TomlDocument& document,
                       std::initializer_list<std::string_view> keys) {
  const TomlReader root(document);
  return static_cast<std::size_t>(
      std::count_if(keys.begin(), keys.end(), [&](std::string_view key) {
        // A character names the file of its subject; a session describes the person.
        return root.has(key) && (key != "subject" || !root.is_table(key));
      }));
}

/// Returns the number of keys that show this kind.
std::size_t count_keys(TomlDocument& document, const KindKeys& kind) {
  // One camera is surer than any word.
  if (kind.kind == TomlKind::kCalibration) return has_lens(document) ? 100 : 0;
  return count_keys(document, kind.keys);
}

const KindKeys* row_of(TomlKind wanted) {
  const auto& kinds = kinds_of_toml();
  const auto row = std::find_if(
      kinds.begin(), kinds.end(), [&](const auto& one) { return one.kind == wanted; });
  return row == kinds.end() ? nullptr : &*row;
}

}  // namespace

TomlKind toml_kind(TomlDocument& document) {
  for (const KindKeys& kind : kinds_of_toml()) {
    if (count_keys(document, kind) > 0) return kind.kind;
  }
  return TomlKind::kUnknown;
}

Error mistake_of(TomlDocument& document, TomlKind wanted) {
  MAREY_ASSERT(document.mistake.has_value());
  // Readers find nothing in a document with a mistake.
  const Error mistake = *document.mistake;
  document.mistake.reset();
  const KindKeys* const own = row_of(wanted);
  MAREY_ASSERT(own != nullptr);
  if (TomlReader(document).keys().empty()) return empty_file(document.file);
  const KindKeys* other = own;
  std::size_t max_keys = count_keys(document, *own) + count_keys(document, own->shared);
  for (const KindKeys& kind : kinds_of_toml()) {
    const std::size_t keys = count_keys(document, kind);
    if (kind.kind == wanted || keys <= max_keys) continue;
    max_keys = keys;
    other = &kind;
  }
  if (other == own) return mistake;
  return bad_input(
      document.file,
      std::string("this is ").append(other->name).append(", not ").append(own->name),
      std::string("give ")
          .append(own->name)
          .append(" as docs/formats/")
          .append(document.page)
          .append(" describes it"));
}

}  // namespace marey::recordings
