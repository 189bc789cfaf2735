// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/labels/label_targets.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/lower_case.h"

namespace marey::app {
namespace {

/// A path in parts.
struct NamedFile {
  std::vector<std::string_view> folders;  ///< The nearest first.
  std::string_view file;
  std::string_view stem;  ///< Without extension, and without endings of AMASS.
};

constexpr std::array<std::string_view, 13> kMotionEndings = {"bvh",
                                                             "amc",
                                                             "npz",
                                                             "glb",
                                                             "gltf",
                                                             "vrm",
                                                             "vrma",
                                                             "c3d",
                                                             "trc",
                                                             "fbx",
                                                             "pkl",
                                                             "npy",
                                                             "toml"};

/// `is_name`: the path is from a table of labels, where "walk.2" may have no extension.
NamedFile parts_of(std::string_view path, bool is_name) {
  NamedFile out;
  while (path.starts_with("./")) path.remove_prefix(2);
  std::size_t slash = path.rfind('/');
  out.file = slash == std::string_view::npos ? path : path.substr(slash + 1);
  while (slash != std::string_view::npos) {
    path = path.substr(0, slash);
    slash = path.rfind('/');
    const std::string_view folder =
        slash == std::string_view::npos ? path : path.substr(slash + 1);
    if (!folder.empty()) out.folders.push_back(folder);
  }
  out.stem = out.file;
  const std::size_t point = out.stem.rfind('.');
  if (point != std::string_view::npos && point > 0) {
    const std::string kind = lower_case(out.stem.substr(point + 1));
    const bool is_extension =
        !is_name || std::ranges::find(kMotionEndings, kind) != kMotionEndings.end();
    if (is_extension) out.stem = out.stem.substr(0, point);
  }
  constexpr std::array<std::string_view, 2> kEndings = {"_poses", "_stageii"};
  for (const std::string_view ending : kEndings) {
    if (out.stem.size() > ending.size() && out.stem.ends_with(ending)) {
      out.stem.remove_suffix(ending.size());
      break;
    }
  }
  return out;
}

/// Returns how well a source fits a name: folders in common, then the same file name.
std::pair<std::size_t, bool> likeness(const NamedFile& name, const NamedFile& source) {
  const auto [a, b] = std::mismatch(name.folders.begin(),
                                    name.folders.end(),
                                    source.folders.begin(),
                                    source.folders.end());
  return {static_cast<std::size_t>(a - name.folders.begin()), name.file == source.file};
}

}  // namespace

LabelTargets::LabelTargets(std::span<const ClipRecord> records) {
  clip_by_id_.reserve(records.size());
  for (std::size_t i = 0; i < records.size(); ++i) {
    clip_by_id_.emplace(records[i].clip_id, i);
    const std::string& path = records[i].provenance.path;
    std::vector<std::size_t>& clips = clips_by_path_[path];
    if (clips.empty()) {
      paths_by_stem_[std::string(parts_of(path, false).stem)].push_back(path);
    }
    clips.push_back(i);
  }
}

LabelTarget LabelTargets::source(const std::string& path) const {
  const auto found = clips_by_path_.find(path);
  if (found == clips_by_path_.end()) return {};
  return {LabelTarget::Kind::kSource, path, found->second};
}

LabelTarget LabelTargets::find(std::string_view name) const {
  const std::string text(name);
  if (const auto clip = clip_by_id_.find(text); clip != clip_by_id_.end()) {
    return {LabelTarget::Kind::kClip, text, {clip->second}};
  }
  if (LabelTarget exact = source(text); exact.is_found()) return exact;
  const NamedFile parts = parts_of(name, true);
  const auto candidates = paths_by_stem_.find(std::string(parts.stem));
  if (candidates == paths_by_stem_.end()) return {};
  const std::string* best = nullptr;
  std::pair<std::size_t, bool> best_likeness{};
  bool is_tied = false;
  for (const std::string& path : candidates->second) {
    const NamedFile other = parts_of(path, false);
    const auto value = likeness(parts, other);
    const bool is_elsewhere =
        !parts.folders.empty() && !other.folders.empty() && value.first == 0;
    if (is_elsewhere) continue;
    if (best == nullptr || value > best_likeness) {
      best = &path;
      best_likeness = value;
      is_tied = false;
    } else if (value == best_likeness) {
      is_tied = true;
    }
  }
  if (best == nullptr) return {};
  if (is_tied) return {LabelTarget::Kind::kAmbiguous, text, {}};
  return source(*best);
}

}  // namespace marey::app
