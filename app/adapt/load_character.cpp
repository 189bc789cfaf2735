// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/adapt/load_character.h"

#include <string>
#include <utility>
#include <variant>

#include "app/motion/error_of_file.h"
#include "app/motion/retarget_files.h"
#include "core/human/average_proportions.h"
#include "recordings/body/character_file.h"
#include "recordings/session/subject_file.h"
#include "retarget/body/body_map.h"
#include "retarget/character/make_character.h"

namespace marey::app {
namespace {

struct LoadedBody {
  Skeleton skeleton;
  std::string file;  ///< File named in errors about the skeleton.
};

Result<LoadedBody> load_body(const std::filesystem::path& path, CharacterSpec& spec) {
  if (const auto* average = std::get_if<AverageBody>(&spec.body)) {
    return LoadedBody{make_humanoid(average_proportions(average->stature_m)),
                      path.string()};
  }
  if (const auto* avatar = std::get_if<AvatarBody>(&spec.body)) {
    auto skeleton = read_skeleton(std::filesystem::path(avatar->path));
    if (!skeleton) return skeleton.error();
    return LoadedBody{*std::move(skeleton), avatar->path};
  }
  const std::string& file = std::get<SubjectBody>(spec.body).path;
  const auto subject = recordings::read_subject(file);
  if (!subject) return subject.error();
  if (!spec.traits.mass.total_kg) spec.traits.mass.total_kg = subject->mass_kg;
  return LoadedBody{make_humanoid(subject->proportions), file};
}

}  // namespace

Result<Character> load_character(const std::filesystem::path& path) {
  auto spec = recordings::read_character_spec(path);
  if (!spec) return spec.error();
  auto body = load_body(path, *spec);
  if (!body) return body.error();
  const auto map = retarget::map_body(body->skeleton);
  if (!map) return of_file(body->file, map.error());
  auto character = retarget::make_character(
      spec->name, std::move((*body).skeleton), *map, spec->traits);
  if (!character) return of_file(path, character.error());
  return character;
}

}  // namespace marey::app
