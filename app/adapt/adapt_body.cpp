// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/adapt/adapt_body.h"

#include <string>
#include <utility>
#include <variant>

#include <glm/geometric.hpp>

#include "app/adapt/load_character.h"
#include "app/motion/error_of_file.h"
#include "app/motion/marey_skeleton.h"
#include "app/motion/retarget_files.h"
#include "core/base/extension.h"
#include "recordings/body/character_file.h"
#include "recordings/body/mannequin.h"
#include "recordings/gltf/gltf.h"
#include "recordings/motion/bvh.h"
#include "retarget/character/make_character.h"
#include "retarget/contacts/detect_contacts.h"
#include "retarget/feet/adapt_to_ground.h"
#include "retarget/motion/retarget_motion.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

/// Returns the character of the file, or of the motion itself.
Result<Character> find_character(const Motion& source, const AdaptBodyOptions& options) {
  if (!options.character.empty()) return load_character(options.character);
  const auto map = retarget::map_body(source.skeleton);
  if (!map) return of_file(options.motion, map.error());
  auto character =
      retarget::make_character(options.motion.stem().string(), source.skeleton, *map);
  if (!character) return of_file(options.motion, character.error());
  return character;
}

/// Returns the file of the character's mesh, if it has one, and how the mesh was rotated
/// and scaled when the character was made from it.
Result<BodyLook> look_of(const AdaptBodyOptions& options) {
  const fs::path file =
      options.character.empty() ? options.motion : body_file_of(options.character);
  if (!is_gltf(file)) return BodyLook{};
  const auto body = read_body(file);
  if (!body) return body.error();
  return BodyLook{file, body->changed()};
}

/// Compares joints with the precision of the six decimals of a file; roots may have
/// different rest positions.
bool are_same(const Skeleton& a, const Skeleton& b) {
  constexpr double kSame = 1e-5;
  if (a.joints.size() != b.joints.size()) return false;
  for (std::size_t j = 0; j < a.joints.size(); ++j) {
    const Joint& x = a.joints[j];
    const Joint& y = b.joints[j];
    const RigidTransform apart = inverse(x.parent_from_joint) * y.parent_from_joint;
    if (x.name != y.name || x.parent != y.parent || x.bone != y.bone) return false;
    if (x.parent && glm::length(apart.translation) > kSame) return false;
    if (glm::length(rotation_vector(apart.rotation)) > kSame) return false;
  }
  return true;
}

void lift(Motion& motion, double by_m) {
  for (Pose& pose : motion.poses) pose.root_in_world.y += by_m;
}

Status place_motion(const Motion& source,
                    const AdaptBodyOptions& options,
                    AdaptBody& body) {
  const Skeleton& skeleton = body.character.skeleton;
  const bool is_own = are_same(source.skeleton, skeleton);
  if (is_own) {
    body.contacts = retarget::detect_contacts(source, body.map);
    body.floor_height_m =
        -retarget::standing_rise_m(body.map, body.contacts, body.map, 1.0);
    body.reference = source;
    body.reference.skeleton = skeleton;
  }
  if (!is_own || options.plant_feet) {
    auto retargeted = retarget::retarget_motion(source, skeleton);
    if (!retargeted) return of_file(options.motion, retargeted.error());
    body.reference = std::move(retargeted->motion);
    body.contacts = std::move(retargeted->report.contacts);
    if (is_own) lift(body.reference, body.floor_height_m);
  }
  lift(body.reference, options.raise_m);
  body.floor_height_m += options.raise_m;
  return Done{};
}

}  // namespace

Result<AdaptBody> make_adapt_body(const Motion& source, const AdaptBodyOptions& options) {
  auto character = find_character(source, options);
  if (!character) return character.error();
  auto map = retarget::map_body(character->skeleton);
  if (!map) return of_file(options.character, map.error());
  auto look = look_of(options);
  if (!look) return look.error();
  AdaptBody body{std::move(*character), std::move(*map), {}, {}, 0.0, *std::move(look)};
  if (const Status ok = place_motion(source, options, body); !ok) return ok.error();
  return body;
}

fs::path body_file_of(const fs::path& character) {
  const auto spec = recordings::read_character_spec(character);
  if (!spec) return {};
  if (const auto* avatar = std::get_if<AvatarBody>(&spec->body)) return avatar->path;
  if (const auto* subject = std::get_if<SubjectBody>(&spec->body)) return subject->path;
  return {};
}

Status check_adapted_out(const AdaptBody& body, const fs::path& out) {
  const std::string kind = kind_by_extension(out);
  if (kind == ".bvh") return Done{};
  if (kind != ".glb") {
    return bad_input(out.string(),
                     "cannot write a \"" + kind + "\" file",
                     "name the result .glb or .bvh");
  }
  if (!body.look.file.empty() || is_marey_skeleton(body.character.skeleton))
    return Done{};
  return bad_input(out.string(),
                   "the body has no mesh to put into a .glb",
                   "give a character with a GLB or VRM avatar, or name the result .bvh");
}

Status write_adapted(const AdaptBody& body, const Motion& motion, const fs::path& out) {
  if (kind_by_extension(out) == ".bvh") return recordings::write_bvh(out, motion);
  if (!body.look.file.empty()) {
    return write_motion_file(out, MotionFormat::kGlb, motion, body.look);
  }
  return recordings::write_character(
      out,
      motion.skeleton,
      recordings::make_mannequin_mesh(proportions_of(motion.skeleton)),
      &motion);
}

}  // namespace marey::app
