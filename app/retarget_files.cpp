// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/retarget_files.h"

#include <array>
#include <cstdio>

#include "core/extension.h"
#include "recordings/bvh.h"
#include "recordings/gltf.h"
#include "retarget/body_map.h"

namespace marey::app {
namespace {

Error unknown_kind(const std::filesystem::path& path) {
  return bad_input(path.string(),
                   "is not a .bvh, .glb, .gltf, .vrm or .vrma file",
                   "convert it to one of these");
}

Result<RetargetedFiles> retarget_only(const Motion& motion,
                                      const std::filesystem::path& avatar) {
  const auto skeleton = read_skeleton(avatar);
  if (!skeleton) return skeleton.error();
  auto retargeted = retarget::retarget_motion(motion, *skeleton);
  if (!retargeted) {
    Error error = retargeted.error();
    error.where = avatar.string() + (error.where.empty() ? "" : ": " + error.where);
    return error;
  }
  return RetargetedFiles{std::move(*retargeted), {}};
}

Status write(RetargetedFiles& result,
             const std::filesystem::path& avatar,
             const std::filesystem::path& out) {
  const Motion& motion = result.retargeted.motion;
  const Status ok = is_gltf(out) ? recordings::write_retargeted(avatar, out, motion)
                                 : recordings::write_bvh(out, motion);
  if (ok) result.files.push_back(out);
  return ok;
}

}  // namespace

bool is_gltf(const std::filesystem::path& path) {
  const std::string kind = kind_by_extension(path);
  return kind == ".glb" || kind == ".gltf" || kind == ".vrm" || kind == ".vrma";
}

Result<RetargetedFiles> retarget_to_files(const Motion& motion,
                                          const std::filesystem::path& avatar,
                                          const std::filesystem::path& stem) {
  auto result = retarget_only(motion, avatar);
  if (!result) return result.error();
  if (is_gltf(avatar)) {
    if (const Status ok = write(*result, avatar, stem.string() + ".glb"); !ok) {
      return ok.error();
    }
  }
  if (const Status ok = write(*result, avatar, stem.string() + ".bvh"); !ok) {
    return ok.error();
  }
  return result;
}

Result<RetargetedFiles> retarget_to_file(const Motion& motion,
                                         const std::filesystem::path& avatar,
                                         const std::filesystem::path& out) {
  const std::string kind = kind_by_extension(out);
  if (kind != ".bvh" && kind != ".glb") {
    return bad_input(out.string(),
                     "cannot write a \"" + kind + "\" file",
                     "name the result .glb or .bvh");
  }
  if (kind == ".glb" && !is_gltf(avatar)) {
    return bad_input(avatar.string(),
                     "has no mesh to put into a .glb",
                     "give a GLB or VRM avatar, or name the result .bvh");
  }
  auto result = retarget_only(motion, avatar);
  if (!result) return result.error();
  if (const Status ok = write(*result, avatar, out); !ok) return ok.error();
  return result;
}

Status check_avatar(const std::filesystem::path& avatar) {
  const auto skeleton = read_skeleton(avatar);
  if (!skeleton) return skeleton.error();
  const auto map = retarget::map_body(*skeleton);
  if (map) return Done{};
  Error error = map.error();
  error.where = avatar.string();
  return error;
}

Result<Skeleton> read_skeleton(const std::filesystem::path& path) {
  if (is_gltf(path)) {
    auto character = recordings::read_character(path);
    if (!character) return character.error();
    return std::move(character->skeleton);
  }
  if (kind_by_extension(path) == ".bvh") {
    auto bvh = recordings::read_bvh(path);
    if (!bvh) return bvh.error();
    return std::move(bvh->motion.skeleton);
  }
  return unknown_kind(path);
}

std::optional<std::string> left_out(const ReadMotion& read) {
  constexpr double kVisible_m = 1e-3;
  if (read.ignored_translation_m <= kVisible_m) return std::nullopt;
  std::array<char, 200> text{};
  std::snprintf(text.data(),
                text.size(),
                "bones move up to %.0f mm against their parents; bones of a body keep "
                "their lengths, so that this is left out",
                1000.0 * read.ignored_translation_m);
  return text.data();
}

Result<ReadMotion> read_motion(const std::filesystem::path& path) {
  if (kind_by_extension(path) == ".bvh") {
    auto bvh = recordings::read_bvh(path);
    if (!bvh) return bvh.error();
    return ReadMotion{std::move(bvh->motion), bvh->ignored_translation_m};
  }
  if (!is_gltf(path)) return unknown_kind(path);
  auto character = recordings::read_character(path);
  if (!character) return character.error();
  if (!character->motion) {
    return bad_input(path.string(), "holds no animation", "give a file with a motion");
  }
  return ReadMotion{std::move(*character->motion), character->ignored_translation_m};
}

}  // namespace marey::app
