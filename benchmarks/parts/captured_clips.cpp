// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/parts/captured_clips.h"

#include <utility>

#include "benchmarks/parts/stand_as_marey.h"
#include "core/humanoid.h"
#include "core/motion.h"
#include "core/transform.h"
#include "recordings/motion/asf.h"
#include "recordings/motion/bvh.h"
#include "retarget/body/body_map.h"
#include "retarget/character/make_character.h"

namespace marey {
namespace {

/// Removes the joints above the hips, which only carry the hips.
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
  traits.mass.table = MassTable::kDempster;  // As in the thesis.
  auto character = retarget::make_character(name, motion.skeleton, *map, traits);
  if (!character) return character.error();
  return CapturedClip{
      std::move(name), *std::move(character), motion.rate.hz, motion.poses};
}

Result<Motion> read_motion(const std::filesystem::path& file) {
  if (file.extension() == ".bvh") {
    auto bvh = recordings::read_bvh(file);
    if (!bvh) return bvh.error();
    return std::move(bvh->motion);
  }
  const auto skeleton_file = recordings::find_skeleton_file(file);
  if (!skeleton_file)
    return bad_input(file.string(), "no .asf next to it", "put it there");
  const auto skeleton = recordings::read_asf(*skeleton_file);
  if (!skeleton) return skeleton.error();
  auto amc = recordings::read_amc(file, *skeleton);
  if (!amc) return amc.error();
  return std::move(amc->motion);
}

}  // namespace

Result<CapturedClip> read_clip(const std::filesystem::path& file, std::string name) {
  auto motion = read_motion(file);
  if (!motion) return motion.error();
  // A BVH has its unit only by convention; CMU's files specify their unit.
  const bool is_bvh = file.extension() == ".bvh";
  const auto ok = stand_as_marey({is_bvh ? 0.01 : 1.0, !is_bvh}, *motion);
  if (!ok) return ok.error();
  return clip_of(std::move(name), without_helpers(*motion));
}

Result<std::vector<CapturedClip>> read_clips(const std::filesystem::path& mocap,
                                             ClipSet set) {
  struct File {
    const char* path;
    const char* name;
    ClipSet set = ClipSet::kReaches;
  };
  std::vector<CapturedClip> clips;
  for (const File& file :
       {File{"cmu_asfamc/02_03.amc", "run (CMU 02_03)", ClipSet::kAll},
        File{"cmu_asfamc/02_04.amc", "jump (CMU 02_04)", ClipSet::kAll},
        File{"cmu_asfamc/02_05.amc", "punch (CMU 02_05)"},
        File{"cmu_asfamc/02_06.amc", "bend, scoop (CMU 02_06)"},
        File{"bandai/dataset-1_kick_normal_001.bvh", "kick (Bandai)"},
        File{"bandai/dataset-1_dance-short_normal_001.bvh", "dance (Bandai)"},
        File{"cmu_bvh_tmoco/05_06.bvh", "dance (CMU 05_06)"},
        File{"bandai/dataset-1_walk_normal_001.bvh", "walk (Bandai)"},
        File{"cmu_bvh_tmoco/02_01.bvh", "walk (CMU 02_01)"}}) {
    if (set != ClipSet::kAll && file.set == ClipSet::kAll) continue;
    if (!std::filesystem::exists(mocap / file.path)) continue;
    auto clip = read_clip(mocap / file.path, file.name);
    if (!clip) return clip.error();
    clips.push_back(*std::move(clip));
  }
  return clips;
}

}  // namespace marey
