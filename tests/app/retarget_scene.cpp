// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/app/retarget_scene.h"

#include <algorithm>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/extension.h"
#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "recordings/base/atomic_file.h"
#include "recordings/body/mannequin.h"
#include "recordings/gltf/gltf.h"
#include "recordings/motion/bvh.h"
#include "tests/support/program/paths.h"

namespace marey::testing {
namespace {

void write_mannequin(const std::filesystem::path& path, double stature_m) {
  const Proportions proportions =
      recordings::mannequin_proportions({.stature_m = stature_m});
  EXPECT_TRUE(recordings::write_character(
      path, make_humanoid(proportions), recordings::make_mannequin_mesh(proportions)));
}

void write_body(const std::filesystem::path& path, const Skeleton& skeleton) {
  EXPECT_TRUE(recordings::write_bvh(
      path, Motion{skeleton, FrameRate{30.0}, 0, {rest_pose(skeleton)}}));
}

}  // namespace

RetargetScene::RetargetScene() : walk_(synthetic_walk(120, 60.0)) {
  EXPECT_TRUE(recordings::write_bvh(folder_ / "walk.bvh", walk_.motion));
  write_mannequin(folder_ / "small.glb", 0.9);
  write_mannequin(folder_ / "tall.glb", 2.4);
  Skeleton plain = make_humanoid(average_proportions(1.6));
  write_body(folder_ / "plain.bvh", plain);
  // Hands come after their arms, which end then.
  std::erase_if(plain.joints, [](const Joint& joint) {
    return joint.bone == HumanBone::kLeftHand || joint.bone == HumanBone::kRightHand;
  });
  for (std::size_t i = 0; i < plain.joints.size(); ++i) {
    auto& parent = plain.joints[i].parent;
    if (!parent) continue;
    const Joint* named = nullptr;
    for (const Joint& joint : walk_.motion.skeleton.joints) {
      if (joint.name == plain.joints[i].name) named = &joint;
    }
    parent = plain.find(walk_.motion.skeleton[*named->parent].name);
  }
  write_body(folder_ / "arms.bvh", plain);
  EXPECT_TRUE(recordings::write_file(folder_ / "bad.glb", "no GLB\n"));
}

ProgramRun RetargetScene::marey(const std::vector<std::string>& arguments) const {
  return run_program(marey::testing::program(),
                     arguments,
                     {.folder = folder_.path(), .interrupt_at = {}});
}

ProgramRun RetargetScene::retarget(const std::vector<std::string>& more) const {
  std::vector<std::string> arguments{"retarget", "walk.bvh"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return marey(arguments);
}

Motion RetargetScene::motion(const std::string& name) const {
  const std::filesystem::path path = folder_ / name;
  if (kind_by_extension(path) == ".bvh") {
    auto bvh = recordings::read_bvh(path);
    EXPECT_TRUE(bvh) << (bvh ? "" : bvh.error().message());
    return bvh ? std::move(bvh->motion) : Motion{};
  }
  auto character = recordings::read_character(path);
  EXPECT_TRUE(character && character->motion) << name;
  return character && character->motion ? *std::move(character->motion) : Motion{};
}

std::string RetargetScene::bytes(const std::string& name) const {
  const auto read = recordings::read_file(folder_ / name);
  EXPECT_TRUE(read) << name;
  return read ? *read : "";
}

bool RetargetScene::has(const std::string& name) const {
  return std::filesystem::exists(folder_ / name);
}

double apart_m(const Motion& a, const Motion& b, HumanBone bone) {
  const auto in_a = a.skeleton.find(bone);
  const auto in_b = b.skeleton.find(bone);
  if (!in_a || !in_b || a.poses.size() != b.poses.size()) return 1e9;
  double largest = 0.0;
  for (std::size_t t = 0; t < a.poses.size(); ++t) {
    largest = std::max(
        largest,
        glm::distance(
            world_from_joints(a.skeleton, a.poses[t])[index(*in_a)].translation,
            world_from_joints(b.skeleton, b.poses[t])[index(*in_b)].translation));
  }
  return largest;
}

}  // namespace marey::testing
