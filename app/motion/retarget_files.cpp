// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/motion/retarget_files.h"

#include <array>
#include <cstdio>
#include <utility>

#include "app/motion/error_of_file.h"
#include "app/motion/reread_motion.h"
#include "retarget/body/body_map.h"

namespace marey::app {
Result<OpenedAvatar> open_avatar(const BodyFile& avatar) {
  auto body = read_body(avatar);
  if (!body) return body.error();
  if (const auto map = retarget::map_body(body->skeleton()); !map) {
    return of_file(avatar.path, map.error());
  }
  OpenedAvatar opened{avatar.path,
                      {},
                      {},
                      body->soles,
                      body->volume,
                      std::move(body->skin),
                      body->remarks(),
                      body->raw.faces_back};
  if (is_gltf(avatar.path)) opened.look = {avatar.path, body->changed()};
  opened.skeleton = std::move(body->raw.motion.skeleton);
  return opened;
}

Result<RetargetedFiles> retarget_to_files(const Motion& motion,
                                          const BodyFile& avatar,
                                          const std::filesystem::path& stem) {
  const auto opened = open_avatar(avatar);
  if (!opened) return opened.error();
  retarget::RetargetOptions options;
  options.soles = opened->soles;
  options.skin = &opened->skin;
  options.compare_steps = true;
  options.hands.emplace().avatar_volume = opened->volume;
  auto retargeted = retarget::retarget_motion(motion, opened->skeleton, options);
  if (!retargeted) return of_file(avatar.path, retargeted.error());
  RetargetedFiles result{*std::move(retargeted), {}, opened->remarks};
  std::vector<WrittenFile> files;
  for (const MotionFormat format :
       {MotionFormat::kGlb, MotionFormat::kBvh, MotionFormat::kVrma}) {
    if (!can_hold(format, opened->skeleton, opened->look)) continue;
    const std::filesystem::path out = stem.string() + "." + std::string(name(format));
    const Status ok =
        write_motion_file(out, format, result.retargeted.motion, opened->look);
    if (!ok) return ok.error();
    result.files.push_back(out);
    files.push_back(written_file(out, format, opened->look));
  }
  auto verdict = assess_avatar(
      avatar.path.string(), motion, result.retargeted, opened->skin, true, files);
  if (!verdict) return of_file(avatar.path, verdict.error());
  result.verdict = *std::move(verdict);
  return result;
}

Status check_avatar(const BodyFile& avatar) {
  const auto opened = open_avatar(avatar);
  return opened ? Status(Done{}) : Status(opened.error());
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
                "bones move up to %.0f mm relative to their parents; this is ignored, "
                "because bones of a body keep their lengths",
                1000.0 * read.ignored_translation_m);
  return text.data();
}

Result<ReadMotion> read_motion(const BodyFile& file) {
  auto raw = read_raw_body(file.path, file.animation);
  if (!raw) return raw.error();
  if (!raw->has_motion) {
    return bad_input(
        file.path.string(), "holds no animation", "give a file with a motion");
  }
  auto body = identify_body(*std::move(raw), file);
  if (!body) return body.error();
  std::vector<std::string> remarks = body->remarks();
  return ReadMotion{std::move(body->raw.motion),
                    body->raw.ignored_translation_m,
                    std::move(remarks),
                    body->exchanged,
                    body->raw.rate_is_guessed,
                    std::move(body->raw.uncertainty),
                    std::move(body->raw.animations)};
}

}  // namespace marey::app
