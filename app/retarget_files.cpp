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

Error of_file(const std::filesystem::path& path, Error error) {
  error.where = path.string() + (error.where.empty() ? "" : ": " + error.where);
  return error;
}

/// A motion on an avatar, and what its file has to know of it.
struct Dressed {
  RetargetedFiles result;
  std::filesystem::path avatar;
  recordings::ChangedFrame changed;
};

Result<Dressed> retarget_only(const Motion& motion, const BodyFile& avatar) {
  const auto body = read_body(avatar);
  if (!body) return body.error();
  retarget::RetargetOptions options;
  options.soles = body->soles;
  auto retargeted = retarget::retarget_motion(motion, body->skeleton(), options);
  if (!retargeted) return of_file(avatar.path, retargeted.error());
  return Dressed{
      {std::move(*retargeted), {}, body->remarks()}, avatar.path, body->changed()};
}

Status write(Dressed& dressed, const std::filesystem::path& out) {
  const Motion& motion = dressed.result.retargeted.motion;
  const Status ok = is_gltf(out)
                        ? recordings::write_retargeted(
                              dressed.avatar, out, motion, "motion", dressed.changed)
                        : recordings::write_bvh(out, motion);
  if (ok) dressed.result.files.push_back(out);
  return ok;
}

}  // namespace

Result<RetargetedFiles> retarget_to_files(const Motion& motion,
                                          const BodyFile& avatar,
                                          const std::filesystem::path& stem) {
  auto dressed = retarget_only(motion, avatar);
  if (!dressed) return dressed.error();
  if (is_gltf(avatar.path)) {
    if (const Status ok = write(*dressed, stem.string() + ".glb"); !ok) {
      return ok.error();
    }
  }
  if (const Status ok = write(*dressed, stem.string() + ".bvh"); !ok) return ok.error();
  return std::move(dressed->result);
}

Result<RetargetedFiles> retarget_to_file(const Motion& motion,
                                         const BodyFile& avatar,
                                         const std::filesystem::path& out) {
  const std::string kind = kind_by_extension(out);
  if (kind != ".bvh" && kind != ".glb") {
    return bad_input(out.string(),
                     "cannot write a \"" + kind + "\" file",
                     "name the result .glb or .bvh");
  }
  if (kind == ".glb" && !is_gltf(avatar.path)) {
    return bad_input(avatar.path.string(),
                     "has no mesh to put into a .glb",
                     "give a GLB or VRM avatar, or name the result .bvh");
  }
  auto dressed = retarget_only(motion, avatar);
  if (!dressed) return dressed.error();
  if (const Status ok = write(*dressed, out); !ok) return ok.error();
  return std::move(dressed->result);
}

Status check_avatar(const BodyFile& avatar) {
  const auto skeleton = read_skeleton(avatar);
  if (!skeleton) return skeleton.error();
  const auto map = retarget::map_body(*skeleton);
  if (map) return Done{};
  return of_file(avatar.path, map.error());
}

Result<Skeleton> read_skeleton(const BodyFile& file) {
  auto body = read_body(file);
  if (!body) return body.error();
  return std::move(body->raw.motion.skeleton);
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

Result<ReadMotion> read_motion(const BodyFile& file) {
  auto raw = read_raw_body(file.path);
  if (!raw) return raw.error();
  if (!raw->has_motion) {
    return bad_input(
        file.path.string(), "holds no animation", "give a file with a motion");
  }
  auto body = identify_body(*std::move(raw), file);
  if (!body) return body.error();
  std::vector<std::string> remarks = body->remarks();
  return ReadMotion{
      std::move(body->raw.motion), body->raw.ignored_translation_m, std::move(remarks)};
}

}  // namespace marey::app
