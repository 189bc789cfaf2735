// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/captured_clips.h"

#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/humanoid.h"
#include "core/motion.h"
#include "core/transform.h"
#include "recordings/atomic_file.h"
#include "recordings/bvh.h"
#include "retarget/body_map.h"
#include "retarget/make_character.h"
#include "retarget/standing_rest.h"
#include "tests/support/acclaim.h"

namespace marey {
namespace {

/// What CMU's database calls its lengths: 1/0.45 of an inch.
constexpr double kAcclaimUnit_m = 0.0254 / 0.45;

/// The bone in the words of three studios, sides left out: VRM, Acclaim, cgspeed's BVH of
/// CMU's database, Bandai.
struct BoneWords {
  std::string_view vrm;
  std::string_view acclaim;
  std::string_view cgspeed;
  std::string_view bandai;
};

constexpr std::array kMiddle{
    BoneWords{"hips", "root", "Hips", "Hips"},
    BoneWords{"spine", "lowerback", "LowerBack", "Spine"},
    BoneWords{"chest", "upperback", "Spine", "Chest"},
    BoneWords{"upperChest", "thorax", "Spine1", ""},
    BoneWords{"neck", "lowerneck", "Neck", "Neck"},
    BoneWords{"head", "head", "Head", "Head"},
};
constexpr std::array kSides{
    BoneWords{"Shoulder", "clavicle", "Shoulder", "Shoulder"},
    BoneWords{"UpperArm", "humerus", "Arm", "UpperArm"},
    BoneWords{"LowerArm", "radius", "ForeArm", "LowerArm"},
    BoneWords{"Hand", "wrist", "Hand", "Hand"},
    BoneWords{"UpperLeg", "femur", "UpLeg", "UpperLeg"},
    BoneWords{"LowerLeg", "tibia", "Leg", "LowerLeg"},
    BoneWords{"Foot", "foot", "Foot", "Foot"},
    BoneWords{"Toes", "toes", "ToeBase", "Toes"},
};

enum class Studio { kAcclaim, kCgspeed, kBandai };

std::string word_of(const BoneWords& words, Studio studio) {
  switch (studio) {
    case Studio::kAcclaim:
      return std::string(words.acclaim);
    case Studio::kCgspeed:
      return std::string(words.cgspeed);
    case Studio::kBandai:
      break;
  }
  return std::string(words.bandai);
}

std::string on_side(const std::string& word, Studio studio, bool is_left) {
  switch (studio) {
    case Studio::kAcclaim:
      return (is_left ? "l" : "r") + word;
    case Studio::kCgspeed:
      return (is_left ? "Left" : "Right") + word;
    case Studio::kBandai:
      break;
  }
  return word + (is_left ? "_L" : "_R");
}

std::optional<HumanBone> bone_of(std::string_view joint, Studio studio) {
  for (const BoneWords& words : kMiddle) {
    if (joint == word_of(words, studio)) return human_bone(words.vrm);
  }
  for (const BoneWords& words : kSides) {
    for (const bool is_left : {true, false}) {
      if (joint != on_side(word_of(words, studio), studio, is_left)) continue;
      return human_bone((is_left ? "left" : "right") + std::string(words.vrm));
    }
  }
  return std::nullopt;
}

void mark_bones(Studio studio, Skeleton& skeleton) {
  for (Joint& joint : skeleton.joints) joint.bone = bone_of(joint.name, studio);
}

/// Joints above the hips, which only carry them, taken out.
Motion without_helpers(const Motion& motion) {
  const std::size_t hips = index(*motion.skeleton.find(HumanBone::kHips));
  if (hips == 0) return motion;
  Motion out{{}, motion.rate, motion.first_frame, {}};
  const auto rest = world_from_joints(motion.skeleton, rest_pose(motion.skeleton));
  for (std::size_t i = hips; i < motion.skeleton.joints.size(); ++i) {
    Joint joint = motion.skeleton.joints[i];
    if (i == hips) {
      joint.parent.reset();
      joint.parent_from_joint = rest[hips];
    } else {
      joint.parent = JointIndex{static_cast<int>(index(*joint.parent) - hips)};
    }
    out.skeleton.joints.push_back(std::move(joint));
  }
  for (const Pose& pose : motion.poses) {
    const RigidTransform world_from_hips = world_from_joints(motion.skeleton, pose)[hips];
    Pose kept;
    kept.root_in_world = world_from_hips.translation;
    kept.parent_from_joint.assign(
        pose.parent_from_joint.begin() + static_cast<std::ptrdiff_t>(hips),
        pose.parent_from_joint.end());
    kept.parent_from_joint[0] = world_from_hips.rotation;
    out.poses.push_back(std::move(kept));
  }
  return out;
}

Result<CapturedClip> clip_of(std::string name, const Motion& motion) {
  const auto map = retarget::map_body(motion.skeleton);
  if (!map) return map.error();
  CharacterTraits traits;
  traits.mass.table = MassTable::kDempster;  // The thesis', whose figures stand beside.
  auto character = retarget::make_character(name, motion.skeleton, *map, traits);
  if (!character) return character.error();
  return CapturedClip{
      std::move(name), *std::move(character), motion.rate.hz, motion.poses};
}

Result<CapturedClip> read_bvh_clip(const std::filesystem::path& file,
                                   Studio studio,
                                   std::string name) {
  const double unit_m = studio == Studio::kBandai ? 0.01 : kAcclaimUnit_m;
  auto read = recordings::read_bvh(file, {unit_m});
  if (!read) return read.error();
  mark_bones(studio, read->motion.skeleton);
  Motion motion = without_helpers(read->motion);
  if (!retarget::rests_standing(motion.skeleton)) {
    motion.skeleton = retarget::standing_rest(motion);
  }
  return clip_of(std::move(name), motion);
}

Result<CapturedClip> read_acclaim_clip(const std::filesystem::path& folder,
                                       const std::string& trial,
                                       std::string name) {
  const auto asf = recordings::read_file(folder / "02.asf");
  if (!asf) return asf.error();
  const auto amc = recordings::read_file(folder / (trial + ".amc"));
  if (!amc) return amc.error();
  const auto bones = testing::parse_asf(*asf, "02.asf");
  if (!bones) return bones.error();
  const auto frames = testing::parse_amc(*bones, *amc, trial);
  if (!frames) return frames.error();
  Motion motion;
  motion.rate.hz = 120.0;
  for (const testing::AcclaimBone& bone : bones->bones) {
    Joint joint;
    joint.name = bone.name;
    if (bone.parent) {
      joint.parent = JointIndex{static_cast<int>(*bone.parent)};
      joint.parent_from_joint.translation = bones->bones[*bone.parent].span_in_root;
    }
    motion.skeleton.joints.push_back(std::move(joint));
  }
  mark_bones(Studio::kAcclaim, motion.skeleton);
  std::vector<glm::dquat> turned(bones->bones.size());
  for (const auto& frame : *frames) {
    const auto file_from_bone = testing::file_from_bones(*bones, frame);
    for (std::size_t i = 0; i < turned.size(); ++i) {
      turned[i] = file_from_bone[i].rotation;
    }
    motion.poses.push_back(
        pose_from_world(motion.skeleton, file_from_bone[0].translation, turned));
  }
  return clip_of(std::move(name), motion);
}

}  // namespace

Result<std::vector<CapturedClip>> read_clips(const std::filesystem::path& mocap) {
  std::vector<CapturedClip> clips;
  for (const auto& [trial, name] : {std::pair{"02_03", "run (CMU 02_03)"},
                                    std::pair{"02_04", "jump (CMU 02_04)"},
                                    std::pair{"02_05", "punch (CMU 02_05)"},
                                    std::pair{"02_06", "bend, scoop (CMU 02_06)"}}) {
    if (!std::filesystem::exists(mocap / "cmu_asfamc" / (std::string(trial) + ".amc"))) {
      continue;
    }
    auto clip = read_acclaim_clip(mocap / "cmu_asfamc", trial, name);
    if (!clip) return clip.error();
    clips.push_back(*std::move(clip));
  }
  struct File {
    const char* path;
    Studio studio;
    const char* name;
  };
  for (const File& file :
       {File{"bandai/dataset-1_kick_normal_001.bvh", Studio::kBandai, "kick (Bandai)"},
        File{"bandai/dataset-1_dance-short_normal_001.bvh",
             Studio::kBandai,
             "dance (Bandai)"},
        File{"cmu_bvh_tmoco/05_06.bvh", Studio::kCgspeed, "dance (CMU 05_06)"},
        File{"bandai/dataset-1_walk_normal_001.bvh", Studio::kBandai, "walk (Bandai)"},
        File{"cmu_bvh_tmoco/02_01.bvh", Studio::kCgspeed, "walk (CMU 02_01)"}}) {
    if (!std::filesystem::exists(mocap / file.path)) continue;
    auto clip = read_bvh_clip(mocap / file.path, file.studio, file.name);
    if (!clip) return clip.error();
    clips.push_back(*std::move(clip));
  }
  return clips;
}

}  // namespace marey
