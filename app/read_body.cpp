// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/read_body.h"

#include <algorithm>
#include <utility>

#include "core/extension.h"
#include "recordings/asf.h"
#include "recordings/bone_map_file.h"
#include "recordings/bvh.h"
#include "retarget/body_map.h"
#include "retarget/fit_volume.h"

namespace marey::app {
namespace {

constexpr double kSure = 0.5;

Error of_file(const std::filesystem::path& path, Error error) {
  error.where = path.string() + (error.where.empty() ? "" : ": " + error.where);
  return error;
}

Result<RawBody> read_bvh(const std::filesystem::path& path) {
  const recordings::BvhReadOptions options;
  auto bvh = recordings::read_bvh(path, options);
  if (!bvh) return bvh.error();
  RawBody raw;
  raw.motion = std::move(bvh->motion);
  raw.has_motion = true;
  raw.ignored_translation_m = bvh->ignored_translation_m;
  // marey's own bodies are of any stature, and it writes what it reads.
  const auto& joints = raw.motion.skeleton.joints;
  const bool is_ours = std::ranges::all_of(
      joints, [](const Joint& joint) { return joint.bone.has_value(); });
  raw.unit = {options.unit_m, is_ours};
  return raw;
}

Result<RawBody> read_acclaim(const std::filesystem::path& path) {
  const auto beside = recordings::skeleton_beside(path);
  if (!beside) {
    return bad_input(path.string(),
                     "the .asf file that goes with this motion is not beside it",
                     "put it there");
  }
  const auto skeleton = recordings::read_asf(*beside);
  if (!skeleton) return skeleton.error();
  auto amc = recordings::read_amc(path, *skeleton);
  if (!amc) return amc.error();
  RawBody raw;
  raw.motion = std::move(amc->motion);
  raw.has_motion = true;
  raw.ignored_translation_m = amc->ignored_translation_m;
  return raw;
}

Result<RawBody> read_gltf(const std::filesystem::path& path) {
  auto character = recordings::read_character(path);
  if (!character) return character.error();
  RawBody raw;
  raw.has_motion = character->motion.has_value();
  raw.ignored_translation_m = character->ignored_translation_m;
  raw.mesh = std::move(character->mesh);
  raw.node_of_joint = std::move(character->node_of_joint);
  raw.faces_back = character->faces_back;
  if (raw.has_motion) {
    raw.motion = *std::move(character->motion);
  } else {
    raw.motion.skeleton = std::move(character->skeleton);
  }
  return raw;
}

void put_into_frame(const retarget::BodyFrame& frame, recordings::SkinnedMesh& mesh) {
  for (glm::dvec3& p : mesh.p_in_world) p = frame.scale * (frame.marey_from_file * p);
  for (glm::dvec3& n : mesh.normal_in_world) n = frame.marey_from_file * n;
}

// What is known of a body by its skin. A body that cannot be mapped is refused elsewhere.
void look_at_skin(const recordings::SkinnedMesh& mesh, ReadBody& body) {
  const Skeleton& skeleton = body.skeleton();
  const auto map = retarget::map_body(skeleton);
  if (!map) return;
  std::vector<JointIndex> carriers;
  std::vector<retarget::SkinPoint> skin;
  for (std::size_t i = 0; i < mesh.skin.size(); ++i) {
    carriers.push_back(mesh.skin[i].joints[0]);
    skin.push_back({mesh.p_in_world[i], mesh.skin[i].joints[0]});
  }
  body.soles = retarget::find_soles(skeleton, *map, mesh.p_in_world, carriers);
  if (!skin.empty()) body.volume = retarget::volume_of_skin(skeleton, *map, skin);
  std::vector<retarget::SkinVertex> vertices;
  for (std::size_t i = 0; i < mesh.skin.size(); ++i) {
    vertices.push_back(
        {mesh.p_in_world[i], mesh.skin[i].joints, mesh.skin[i].weights});
  }
  body.skin = retarget::Skin(skeleton, *map, vertices);
}

Result<BoneMap> told_of(const BodyFile& file, ReadBody& body) {
  const std::filesystem::path beside = recordings::bone_map_beside(file.path);
  std::error_code ignored;
  if (file.bone_map) {
    body.bone_map = file.bone_map;
  } else if (std::filesystem::exists(beside, ignored)) {
    body.bone_map = beside;
  } else {
    return BoneMap{};
  }
  return recordings::read_bone_map(*body.bone_map, body.skeleton());
}

}  // namespace

bool is_gltf(const std::filesystem::path& path) {
  const std::string kind = kind_by_extension(path);
  return kind == ".glb" || kind == ".gltf" || kind == ".vrm" || kind == ".vrma";
}

Result<RawBody> read_raw_body(const std::filesystem::path& path) {
  if (is_gltf(path)) return read_gltf(path);
  if (kind_by_extension(path) == ".bvh") return read_bvh(path);
  if (kind_by_extension(path) == ".amc") return read_acclaim(path);
  return bad_input(path.string(),
                   "is not a .bvh, .amc, .glb, .gltf, .vrm or .vrma file",
                   "convert it to one of these");
}

std::vector<std::string> ReadBody::remarks() const {
  std::vector<std::string> all = bones.remarks;
  all.insert(all.end(), frame.remarks.begin(), frame.remarks.end());
  if (rests_as_in_motion) {
    all.push_back(
        "its rest is no posture of a body: one that stands is made of its "
        "motion");
  }
  if (std::ranges::any_of(bones.bones, [](const auto& found) {
        return found && found->evidence == retarget::BoneEvidence::kShape;
      })) {
    all.push_back(
        "its bones are told by its shape, no names or marks say them: look at what "
        "marey inspect --picture draws, and correct it with a bone map");
  }
  std::string unsure;
  for (const HumanBone bone : human_bones()) {
    const auto& found = bones.bones[index(bone)];
    if (!found || found->confidence >= kSure) continue;
    unsure += (unsure.empty() ? "" : ", ") + std::string(name(bone));
  }
  if (!unsure.empty()) all.push_back("not sure: " + unsure);
  return all;
}

Result<ReadBody> identify_body(RawBody raw, const BodyFile& file) {
  ReadBody body;
  body.raw = std::move(raw);
  Motion& motion = body.raw.motion;
  const auto told = told_of(file, body);
  if (!told) return told.error();
  auto bones = retarget::identify_bones(motion.skeleton, *told);
  if (!bones) return of_file(file.path, bones.error());
  body.bones = *std::move(bones);
  if (!motion.poses.empty() && !retarget::stands_at_rest(motion.skeleton, body.bones)) {
    retarget::rest_as_standing(motion, body.bones);
    body.rests_as_in_motion = true;
  }
  auto frame =
      retarget::find_body_frame(motion.skeleton, body.raw.unit, *told, body.bones);
  if (!frame) return of_file(file.path, frame.error());
  body.frame = *std::move(frame);
  retarget::mark(body.bones, motion.skeleton);
  retarget::put_into_frame(body.frame, motion);
  body.raw.ignored_translation_m *= body.frame.scale;
  if (body.raw.mesh) {
    put_into_frame(body.frame, *body.raw.mesh);
    look_at_skin(*body.raw.mesh, body);
  }
  return body;
}

Result<ReadBody> read_body(const BodyFile& file) {
  auto raw = read_raw_body(file.path);
  if (!raw) return raw.error();
  return identify_body(*std::move(raw), file);
}

}  // namespace marey::app
