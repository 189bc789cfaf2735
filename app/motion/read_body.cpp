// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/motion/read_body.h"

#include <algorithm>
#include <utility>

#include "app/motion/error_of_file.h"
#include "app/shell/program_name.h"
#include "core/base/extension.h"
#include "recordings/body/bone_map_file.h"
#include "retarget/body/body_map.h"
#include "retarget/body/volume_of_skin.h"
#include "retarget/bones/identify_bones.h"
#include "retarget/bones/reparent_bones.h"

namespace marey::app {
namespace {

constexpr double kSure = 0.5;

void put_into_frame(const retarget::BodyFrame& frame, recordings::SkinnedMesh& mesh) {
  for (glm::dvec3& p : mesh.p_in_world) p = frame.scale * (frame.marey_from_file * p);
  for (glm::dvec3& n : mesh.normal_in_world) n = frame.marey_from_file * n;
}

// Measures a body by its skin. Bodies that cannot be mapped are rejected by other checks.
void measure_by_skin(const recordings::SkinnedMesh& mesh, ReadBody& body) {
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
    vertices.push_back({mesh.p_in_world[i], mesh.skin[i].joints, mesh.skin[i].weights});
  }
  body.skin = retarget::Skin(skeleton, *map, vertices);
}

Result<BoneMap> find_bone_map(const BodyFile& file, ReadBody& body) {
  const std::filesystem::path default_map = recordings::bone_map_path(file.path);
  std::error_code ignored;
  if (file.bone_map) {
    body.bone_map = file.bone_map;
  } else if (std::filesystem::exists(default_map, ignored)) {
    body.bone_map = default_map;
  } else {
    return BoneMap{};
  }
  return recordings::read_bone_map(*body.bone_map, body.skeleton());
}

/// Sets the rest of a body whose nodes hold an animation frame to its skin's bind pose.
void take_bound_pose(ReadBody& body) {
  if (!body.raw.bound) return;
  Skeleton& skeleton = body.raw.motion.skeleton;
  recordings::BoundBody& bound = *body.raw.bound;
  constexpr double kAsAlike = 0.03;
  const double now = retarget::asymmetry(skeleton, body.bones);
  const double then = retarget::asymmetry(bound.skeleton, body.bones);
  const bool stands = retarget::stands_at_rest(skeleton, body.bones);
  const bool bound_stands = retarget::stands_at_rest(bound.skeleton, body.bones);
  const bool is_better = bound_stands && (!stands || now > 3.0 * then + kAsAlike);
  if (!is_better) return;
  skeleton = std::move(bound.skeleton);
  body.raw.mesh = std::move(bound.mesh);
  body.raw.bound.reset();
  body.rests_as_bound = true;
}

template <class T>
std::vector<T> reordered(const std::vector<T>& list,
                         const std::vector<std::optional<JointIndex>>& read_joint,
                         T otherwise) {
  std::vector<T> out;
  for (const auto& joint : read_joint) {
    out.push_back(joint ? list[index(*joint)] : otherwise);
  }
  return out;
}

/// Changes the parents of bones that have other parents in the file.
Status reparent_bones(ReadBody& body) {
  RawBody& raw = body.raw;
  auto moved =
      retarget::reparent_to_carriers(raw.motion.skeleton, body.bones, raw.carries_skin);
  if (!moved) return moved.error();
  if (!*moved) return Done{};
  retarget::ReparentedBody& made = **moved;
  std::vector<std::size_t> new_joint(raw.motion.skeleton.joints.size());
  for (std::size_t i = 0; i < made.read_joint.size(); ++i) {
    if (made.read_joint[i]) new_joint[index(*made.read_joint[i])] = i;
  }
  retarget::convert_to_reparented(made, raw.motion);
  body.bones = std::move(made.found);
  if (!raw.node_of_joint.empty()) {
    raw.node_of_joint = reordered(raw.node_of_joint, made.read_joint, -1);
  }
  if (!raw.carries_skin.empty()) {
    raw.carries_skin = reordered(raw.carries_skin, made.read_joint, false);
  }
  for (std::vector<JointUncertainty>& frame : raw.uncertainty) {
    frame = reordered(frame, made.read_joint, JointUncertainty{});
  }
  if (raw.mesh) {
    for (recordings::SkinWeights& skin : raw.mesh->skin) {
      for (JointIndex& joint : skin.joints) {
        joint = JointIndex{static_cast<int>(new_joint[index(joint)])};
      }
    }
  }
  raw.bound.reset();
  body.read_joint = std::move(made.read_joint);
  return Done{};
}

}  // namespace

std::vector<std::string> ReadBody::remarks() const {
  std::vector<std::string> all = bones.remarks;
  all.insert(all.end(), frame.remarks.begin(), frame.remarks.end());
  if (neutral == NeutralKind::kTPose && file_rest_stands) {
    all.push_back(
        "its neutral is a T-pose computed from the directions of its bones, as set by "
        "--neutral, although the body stands in its rest");
  } else if (neutral == NeutralKind::kTPose) {
    all.push_back(
        "its rest is not a standing posture: its neutral is a T-pose computed from the "
        "directions of its bones, with the average slope of feet; --neutral sets "
        "another");
  }
  constexpr double kMinUprightShare = 0.7;
  const bool is_usual = guessed_up && guessed_up->axis == glm::dvec3(0.0, 1.0, 0.0) &&
                        guessed_up->share >= kMinUprightShare;
  if (guessed_up && !is_usual) {
    const auto percent = std::lround(100.0 * guessed_up->share);
    all.push_back(
        "its rest does not show where up is, and it does not stand most of the "
        "time: up is taken as " +
        retarget::axis_word(guessed_up->axis) +
        ", along which its hips are above its feet in " + std::to_string(percent) +
        " % of its frames; if that is wrong, give `up` in a bone map");
  }
  if (rests_as_bound) {
    all.push_back(
        "its nodes rest in another posture than the bind pose of its skin; the bind pose "
        "is used");
  }
  if (std::ranges::any_of(bones.bones, [](const auto& found) {
        return found && found->evidence == retarget::BoneEvidence::kShape;
      })) {
    all.push_back(
        "its bones were found by its shape, without names or marks: check them with "
        "marey inspect --picture, and correct them with a bone map");
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
  const auto bone_map = find_bone_map(file, body);
  if (!bone_map) return bone_map.error();
  auto bones = retarget::identify_bones(motion.skeleton, *bone_map);
  if (!bones) return of_file(file.path, bones.error());
  body.bones = *std::move(bones);
  take_bound_pose(body);
  if (const Status ok = reparent_bones(body); !ok) return of_file(file.path, ok.error());
  if (!motion.poses.empty()) {
    body.file_rest_stands = retarget::stands_at_rest(motion.skeleton, body.bones);
    body.exchanged =
        retarget::exchanged_sides(retarget::side_evidence(motion, body.bones));
    if (!body.file_rest_stands && !bone_map->up) {
      body.guessed_up = retarget::up_of_motion(motion, body.bones);
    }
  }
  const auto neutral =
      set_neutral(file.neutral.value_or(Neutral{}), body.bones, motion, bone_map->up);
  if (!neutral) return of_file(file.path, neutral.error());
  body.neutral = *neutral;
  auto frame =
      retarget::find_body_frame(motion.skeleton, body.raw.unit, *bone_map, body.bones);
  if (!frame) return of_file(file.path, frame.error());
  body.frame = *std::move(frame);
  retarget::mark(body.bones, motion.skeleton);
  retarget::put_into_frame(body.frame, motion);
  body.raw.ignored_translation_m *= body.frame.scale;
  if (body.raw.mesh) {
    put_into_frame(body.frame, *body.raw.mesh);
    measure_by_skin(*body.raw.mesh, body);
  }
  return body;
}

std::optional<Finding> assess_exchanged_sides(const std::filesystem::path& path,
                                              retarget::ExchangedSides exchanged,
                                              const std::string& map_option) {
  using retarget::ExchangedSides;
  if (exchanged == ExchangedSides::kNone) return std::nullopt;
  const bool is_arms = exchanged == ExchangedSides::kArms;
  const std::string cause =
      is_arms ? "the arms have their left on the legs' right side: left and right of the "
                "arms are exchanged"
      : exchanged == ExchangedSides::kLegs
          ? "knees bend and feet point backwards, and the arms have their left on the "
            "other side: left and right of the legs are exchanged"
          : "knees bend, feet point or the body walks backwards, against the front that "
            "its left and right give: left and right are exchanged";
  return Finding{Severity::kPoor,
                 "sides",
                 path.string(),
                 cause,
                 "exchange the names in a bone map (" +
                     shell_command({"marey", "inspect", path.string()}) +
                     " --write-map MAP.toml stores one to edit) and give it with " +
                     map_option};
}

Result<ReadBody> read_body(const BodyFile& file) {
  auto raw = read_raw_body(file.path, file.animation);
  if (!raw) return raw.error();
  return identify_body(*std::move(raw), file);
}

}  // namespace marey::app
