// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/labels/apply_map.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "core/base/assert.h"
#include "core/humanoid.h"
#include "core/nearest_word.h"
#include "reconstruct/labels/landmarks.h"

namespace marey::reconstruct {
namespace {

const Landmark* landmark_or_bone(std::string_view name) {
  if (const Landmark* landmark = find_landmark(name)) return landmark;
  if (const auto bone = human_bone(name)) return &somewhere_on(*bone);
  return nullptr;
}

Error unknown_name(const MarkerMap& map, const MarkerMapEntry& entry) {
  std::vector<std::string_view> words;
  for (const Landmark& landmark : landmarks()) words.push_back(landmark.name);
  for (const HumanBone bone : human_bones()) words.push_back(name(bone));
  const auto near = nearest_words(entry.name, words, 3);
  std::string next = "perhaps you mean ";
  for (std::size_t i = 0; i < near.size(); ++i) {
    if (i > 0) next.append(i + 1 == near.size() ? " or " : ", ");
    next.append("\"").append(near[i]).append("\"");
  }
  return bad_input(map.file + ":" + std::to_string(entry.line),
                   "no landmark and no bone is called \"" + entry.name + "\"",
                   next + "; docs/formats/README.md lists all");
}

/// Returns true if the map's label refers to the recording's `label`.
bool is_meant(std::string_view label,
              std::string_view in_map,
              std::string_view names_prefix) {
  if (label == in_map) return true;
  if (!label.ends_with(in_map)) return false;
  const std::string_view before = label.substr(0, label.size() - in_map.size());
  return before.ends_with(':') || before == names_prefix;
}

}  // namespace

Result<MarkerNames> apply_map(const MarkerMap& map,
                              std::span<const std::string> labels,
                              MarkerNames names) {
  MAREY_ASSERT(names.landmarks.size() == labels.size());
  names.is_computed.resize(labels.size());
  names.is_ignored.resize(labels.size());
  bool is_any_found = map.entries.empty();
  for (const MarkerMapEntry& entry : map.entries) {
    const Landmark* landmark = landmark_or_bone(entry.name);
    if (landmark == nullptr && !entry.name.empty()) return unknown_name(map, entry);
    bool is_found = false;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (!is_meant(labels[i], entry.label, names.prefix)) continue;
      names.landmarks[i] = landmark;
      names.is_computed[i] = false;
      names.is_ignored[i] = landmark == nullptr;
      is_found = true;
    }
    is_any_found = is_any_found || is_found;
    if (is_found) continue;
    names.notes.push_back("the recording has no marker \"" + entry.label + "\" (" +
                          map.file + ":" + std::to_string(entry.line) + ")");
  }
  if (!is_any_found) {
    return bad_input(map.file + ":" + std::to_string(map.entries.front().line),
                     "the recording has none of these labels",
                     "marey inspect lists the labels of a recording");
  }
  return names;
}

}  // namespace marey::reconstruct
