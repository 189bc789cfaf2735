// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/motion/raw_body.h"

#include <algorithm>
#include <array>
#include <ranges>
#include <string>
#include <string_view>
#include <utility>

#include "app/shell/word_list.h"
#include "core/base/extension.h"
#include "core/base/input_file.h"
#include "recordings/library/motion_object.h"
#include "recordings/motion/asf.h"
#include "recordings/motion/bvh.h"
#include "recordings/motion/npz.h"

namespace marey::app {
namespace {

Result<RawBody> read_bvh(const std::filesystem::path& path, std::size_t /*animation*/) {
  const recordings::BvhReadOptions options;
  auto bvh = recordings::read_bvh(path, options);
  if (!bvh) return bvh.error();
  RawBody raw;
  raw.motion = std::move(bvh->motion);
  raw.has_motion = true;
  raw.ignored_translation_m = bvh->ignored_translation_m;
  // marey's own bodies may have any stature, and marey reads the files that it writes.
  const auto& joints = raw.motion.skeleton.joints;
  const bool is_ours = std::ranges::all_of(
      joints, [](const Joint& joint) { return joint.bone.has_value(); });
  raw.unit = {options.unit_m, is_ours};
  return raw;
}

Result<RawBody> read_acclaim(const std::filesystem::path& path,
                             std::size_t /*animation*/) {
  const auto asf_file = recordings::find_skeleton_file(path);
  if (!asf_file) {
    return bad_input(path.string(),
                     "the .asf file of this motion is not in its folder",
                     "put it next to the .amc file");
  }
  const auto skeleton = recordings::read_asf(*asf_file);
  if (!skeleton) return skeleton.error();
  auto amc = recordings::read_amc(path, *skeleton);
  if (!amc) return amc.error();
  RawBody raw;
  raw.motion = std::move(amc->motion);
  raw.has_motion = true;
  raw.ignored_translation_m = amc->ignored_translation_m;
  raw.rate_is_guessed = amc->rate_is_guessed;
  return raw;
}

/// Reads poses and uncertainty. Contacts are not part of a body.
template <class Archive>
Result<RawBody> body_of(Result<Archive> archive) {
  if (!archive) return archive.error();
  RawBody raw;
  raw.has_motion = true;
  raw.motion = std::move(archive->motion);
  raw.uncertainty = std::move(archive->uncertainty);
  raw.unit = {1.0, true};
  return raw;
}

Result<RawBody> read_npz(const std::filesystem::path& path, std::size_t /*animation*/) {
  constexpr int kLibraryLayout = 2;
  if (recordings::npz_layout(path) == kLibraryLayout) {
    return body_of(recordings::read_motion_object(path));
  }
  return body_of(recordings::read_npz(path));
}

Result<RawBody> read_gltf(const std::filesystem::path& path, std::size_t animation) {
  auto character = recordings::read_character(path, {animation});
  if (!character) return character.error();
  RawBody raw;
  raw.has_motion = character->motion.has_value();
  raw.ignored_translation_m = character->ignored_translation_m;
  raw.mesh = std::move(character->mesh);
  raw.node_of_joint = std::move(character->node_of_joint);
  raw.faces_back = character->faces_back;
  raw.carries_skin = std::move(character->carries_skin);
  raw.bound = std::move(character->bound);
  raw.animations = std::move(character->animations);
  if (raw.has_motion) {
    raw.motion = *std::move(character->motion);
  } else {
    raw.motion.skeleton = std::move(character->skeleton);
  }
  return raw;
}

using Reader = Result<RawBody> (*)(const std::filesystem::path&, std::size_t animation);

/// The readers of all kinds of files, by extension.
constexpr std::array<std::pair<std::string_view, Reader>, 7> kReaders{
    {{".bvh", read_bvh},
     {".amc", read_acclaim},
     {".npz", read_npz},
     {".glb", read_gltf},
     {".gltf", read_gltf},
     {".vrm", read_gltf},
     {".vrma", read_gltf}}};

/// Returns nullptr if there is none for the file's extension.
Reader find_reader(const std::filesystem::path& path) {
  const std::string extension = kind_by_extension(path);
  const auto found = std::ranges::find_if(
      kReaders, [&](const auto& reader) { return reader.first == extension; });
  return found == kReaders.end() ? nullptr : found->second;
}

}  // namespace

bool is_gltf(const std::filesystem::path& path) {
  const std::string kind = kind_by_extension(path);
  return kind == ".glb" || kind == ".gltf" || kind == ".vrm" || kind == ".vrma";
}

std::string body_extensions() {
  return or_list(kReaders | std::views::keys);
}

bool is_body_file(const std::filesystem::path& path) {
  return find_reader(path) != nullptr;
}

Result<RawBody> read_raw_body(const std::filesystem::path& path, std::size_t animation) {
  if (const Status ok = check_input_file(path); !ok) return ok.error();
  if (const Reader reader = find_reader(path)) return reader(path, animation);
  return bad_input(path.string(),
                   "marey reads no motion or body of this kind",
                   "give a file of one of these kinds: " + body_extensions());
}

}  // namespace marey::app
