// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes one wild motion for other programs to read. Each file has a .csv of the joint
// places that they must reproduce: make_sample_motions FOLDER [AVATAR.vrm].
//   NAME.bvh        for every dialect and every order of rotations
//   motion.vrma     to be played on child.glb
//   avatar.vrma     of the bones that the avatar has, if one is named
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <string>

#include "core/pose.h"
#include "recordings/body/mannequin.h"
#include "recordings/gltf/gltf.h"
#include "recordings/gltf/vrma.h"
#include "recordings/motion/bvh.h"
#include "recordings/motion/bvh_names.h"
#include "tests/recordings/wild_motion.h"

namespace {

using namespace marey;
using namespace marey::recordings;

/// joints.csv with more decimals. `names` has one per joint; those without are left out.
bool write_places(const std::filesystem::path& path,
                  const Motion& motion,
                  const std::vector<std::string>& names) {
  std::ofstream file(path);
  file << "frame,time,joint,x,y,z,sigma\n" << std::fixed << std::setprecision(7);
  for (std::size_t frame = 0; frame < motion.poses.size(); ++frame) {
    const auto joints = world_from_joints(motion.skeleton, motion.poses[frame]);
    for (std::size_t i = 0; i < joints.size(); ++i) {
      if (names[i].empty()) continue;
      const glm::dvec3& p = joints[i].translation;
      file << frame << ',' << static_cast<double>(frame) / motion.rate.hz << ','
           << names[i] << ',' << p.x << ',' << p.y << ',' << p.z << ",0\n";
    }
  }
  return file.good();
}

bool good(const Status& status) {
  if (!status) std::cerr << status.error().message() << "\n";
  return status.has_value();
}

bool write_dialects(const std::filesystem::path& folder, const Motion& motion) {
  struct Style {
    std::string name;
    BvhWriteOptions options;
  };
  std::vector<Style> styles{{"xyz", {.order = BvhOrder::kXyz}},
                            {"xzy", {.order = BvhOrder::kXzy}},
                            {"yxz", {.order = BvhOrder::kYxz}},
                            {"yzx", {.order = BvhOrder::kYzx}},
                            {"zxy", {.order = BvhOrder::kZxy}},
                            {"zyx", {.order = BvhOrder::kZyx}}};
  for (const BvhDialect dialect :
       {BvhDialect::kBlender, BvhDialect::kMobu, BvhDialect::kMaya, BvhDialect::kUnity}) {
    styles.push_back({std::string(name(dialect)), write_options(dialect)});
  }
  bool ok = true;
  for (const auto& [name, options] : styles) {
    ok = good(write_bvh(folder / (name + ".bvh"), motion, options)) &&
         write_places(folder / (name + ".csv"),
                      motion,
                      bvh_names(motion.skeleton, options.names)) &&
         ok;
  }
  return ok;
}

/// Returns the motion that a VRM player must show. Bones turn from the T-pose as in the
/// source. The hips' place is scaled by the ratio of the hips' heights at rest. Both rest
/// in T-poses.
Motion played_on(const Skeleton& avatar, const Motion& source) {
  const auto rest = world_from_joints(avatar, rest_pose(avatar));
  const auto source_rest = world_from_joints(source.skeleton, rest_pose(source.skeleton));
  const std::size_t hips = index(avatar.find(HumanBone::kHips).value());
  const std::size_t source_hips = index(source.skeleton.find(HumanBone::kHips).value());
  const double larger = rest[hips].translation.y / source_rest[source_hips].translation.y;
  Motion played;
  played.skeleton = avatar;
  played.rate = source.rate;
  for (const Pose& pose : source.poses) {
    const auto from = world_from_joints(source.skeleton, pose);
    std::vector<glm::dquat> world;
    for (std::size_t i = 0; i < avatar.joints.size(); ++i) {
      const Joint& joint = avatar.joints[i];
      const auto bone = joint.bone ? source.skeleton.find(*joint.bone) : std::nullopt;
      if (bone) {
        const glm::dquat turned = from[index(*bone)].rotation *
                                  glm::conjugate(source_rest[index(*bone)].rotation);
        world.push_back(glm::normalize(turned * rest[i].rotation));
      } else {
        const glm::dquat above =
            joint.parent ? world[index(*joint.parent)] : glm::dquat(1.0, 0.0, 0.0, 0.0);
        world.push_back(above * joint.parent_from_joint.rotation);
      }
    }
    Pose& out = played.poses.emplace_back(
        pose_from_world(avatar, avatar.joints[0].parent_from_joint.translation, world));
    const auto posed = world_from_joints(avatar, out);
    out.root_in_world += larger * from[source_hips].translation - posed[hips].translation;
  }
  return played;
}

bool write_played(const std::filesystem::path& path,
                  const Skeleton& avatar,
                  const Motion& source) {
  std::vector<std::string> names;
  for (const Joint& joint : avatar.joints) {
    const bool played = joint.bone && source.skeleton.find(*joint.bone);
    names.emplace_back(played ? name(*joint.bone) : "");
  }
  return write_places(path, played_on(avatar, source), names);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 && argc != 3) {
    std::cerr << "usage: make_sample_motions FOLDER [AVATAR.vrm]\n";
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  const Proportions body = mannequin_proportions({});
  Motion motion = wild_motion(make_humanoid(uneven(body)), 40);
  motion.rate.hz = 29.97;
  bool ok = write_dialects(folder, motion);

  Motion turned = wild_motion(with_turned_axes(motion.skeleton), 40);
  turned.rate = motion.rate;
  ok = good(write_vrma(folder / "motion.vrma", turned)) && ok;
  const Proportions child = mannequin_proportions({.stature_m = 1.1, .leg = 0.9});
  const Skeleton small = make_humanoid(child);
  ok = good(write_character(
           folder / "child.glb", small, make_mannequin_mesh(child), nullptr)) &&
       write_played(folder / "child.csv", small, turned) && ok;
  if (argc == 3) {
    const auto avatar = read_character(argv[2]);
    if (!avatar) std::cerr << avatar.error().message() << "\n";
    if (!avatar) return 1;
    // A player ignores the rotations of bones that the avatar lacks. Here such joints are
    // no bones and rest, because write_vrma() aims the bones above joints that are no
    // bones at the bones below them.
    for (std::size_t i = 0; i < turned.skeleton.joints.size(); ++i) {
      Joint& joint = turned.skeleton.joints[i];
      if (!joint.bone || avatar->skeleton.find(*joint.bone)) continue;
      joint.bone.reset();
      for (Pose& pose : turned.poses) {
        pose.parent_from_joint[i] = joint.parent_from_joint.rotation;
      }
    }
    ok = good(write_vrma(folder / "avatar.vrma", turned)) &&
         write_played(folder / "avatar.csv", avatar->skeleton, turned) && ok;
  }
  return ok ? 0 : 1;
}
