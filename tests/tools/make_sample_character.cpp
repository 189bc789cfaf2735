// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes a character with a wild motion, as NAME.bvh, NAME.glb and the NAME.csv that both
// must agree with, for other programs to read: make_sample_character FOLDER NAME BODY,
// where BODY is average, child, giant or uneven.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <string>

#include "core/pose.h"
#include "recordings/body/mannequin.h"
#include "recordings/gltf/gltf.h"
#include "recordings/motion/bvh.h"
#include "tests/recordings/wild_motion.h"

namespace {

marey::Proportions body(const std::string& kind) {
  using marey::recordings::mannequin_proportions;
  if (kind == "child") {
    return mannequin_proportions(
        {.stature_m = 1.10, .arm = 1.2, .leg = 0.9, .head = 1.35});
  }
  if (kind == "giant") {
    return mannequin_proportions(
        {.stature_m = 2.60, .leg = 1.1, .head = 0.85, .shoulder_width = 1.25});
  }
  const marey::Proportions average = mannequin_proportions({});
  return kind == "uneven" ? marey::recordings::uneven(average) : average;
}

bool write_joints(const std::filesystem::path& path, const marey::Motion& motion) {
  std::ofstream file(path);
  file << "frame,time,joint,x,y,z,sigma\n" << std::fixed << std::setprecision(7);
  for (std::size_t frame = 0; frame < motion.poses.size(); ++frame) {
    const auto joints = marey::world_from_joints(motion.skeleton, motion.poses[frame]);
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const glm::dvec3& p = joints[i].translation;
      file << frame << ',' << static_cast<double>(frame) / motion.rate.hz << ','
           << motion.skeleton.joints[i].name << ',' << p.x << ',' << p.y << ',' << p.z
           << ",0\n";
    }
  }
  return file.good();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "usage: make_sample_character FOLDER NAME average|child|giant|uneven\n";
    return 2;
  }
  const std::filesystem::path stem = std::filesystem::path(argv[1]) / argv[2];
  const marey::Proportions proportions = body(argv[3]);
  const marey::Motion motion =
      marey::recordings::wild_motion(marey::make_humanoid(proportions), 40);
  const auto mesh = marey::recordings::make_mannequin_mesh(proportions);
  std::size_t corners = 0;
  for (const auto& part : mesh.parts) corners += part.triangles.size();
  std::cerr << stem.string() << ": " << corners / 3 << " triangles\n";

  const auto bvh = marey::recordings::write_bvh(stem.string() + ".bvh", motion);
  const auto glb = marey::recordings::write_character(
      stem.string() + ".glb", motion.skeleton, mesh, &motion);
  for (const marey::Status& status : {bvh, glb}) {
    if (!status) std::cerr << status.error().message() << "\n";
    if (!status) return 1;
  }
  return write_joints(stem.string() + ".csv", motion) ? 0 : 1;
}
