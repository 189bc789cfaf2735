// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/app/adapt/adapt_scene.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/pose.h"
#include "recordings/base/atomic_file.h"
#include "recordings/motion/bvh.h"
#include "tests/support/program/paths.h"

namespace marey::testing {

AdaptScene::AdaptScene() : walk_(synthetic_walk(90, 30.0)) {
  EXPECT_TRUE(recordings::write_bvh(folder_ / "walk.bvh", walk_.motion));
}

std::string AdaptScene::file(const std::string& name, const std::string& text) const {
  EXPECT_TRUE(recordings::write_file(folder_ / name, text));
  return (folder_ / name).string();
}

std::string AdaptScene::constraints(const std::string& elements) const {
  return file("c.xml", "<ConstraintsSet>\n" + elements + "\n</ConstraintsSet>\n");
}

std::string AdaptScene::character(const std::string& more) const {
  return file("c.toml", "format = 1\nname = \"Ann\"\n" + more);
}

ProgramRun AdaptScene::adapt(const std::vector<std::string>& more) const {
  std::vector<std::string> arguments{"adapt", (folder_ / "walk.bvh").string(), "--json"};
  if (std::find(more.begin(), more.end(), "--out") == more.end()) {
    arguments.insert(arguments.end(), {"--out", (folder_ / "out.bvh").string()});
  }
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_program(marey::testing::program(), arguments);
}

Motion AdaptScene::motion(const std::string& name) const {
  auto bvh = recordings::read_bvh(folder_ / name);
  EXPECT_TRUE(bvh) << (bvh ? "" : bvh.error().message());
  if (!bvh) return {};
  EXPECT_LT(bvh->ignored_translation_m, 1e-9) << "bones keep their lengths";
  return std::move(bvh->motion);
}

std::string hand_at(const glm::dvec3& p_in_world,
                    const std::string& more,
                    const std::string& segment) {
  const auto number = [](double x) { return std::to_string(x); };
  return "<Distance><name>hand</name>"
         "<start_time>0.79</start_time><start_duration>0.2</start_duration>"
         "<stop_time>1.41</stop_time><stop_duration>0.2</stop_duration>" +
         more + "<bodyPoint><segment>" + segment +
         "</segment></bodyPoint><specif><distance>0</distance><position><X>" +
         number(p_in_world.x) + "</X><Y>" + number(p_in_world.y) + "</Y><Z>" +
         number(p_in_world.z) + "</Z></position></specif></Distance>";
}

const nlohmann::json& of_id(const nlohmann::json& all, const std::string& id) {
  for (const nlohmann::json& one : all) {
    if (one.at("id") == id) return one;
  }
  ADD_FAILURE() << "no " << id << " in " << all.dump();
  return all;
}

glm::dvec3 place_of(const Motion& motion, int frame, HumanBone bone) {
  const auto joint = motion.skeleton.find(bone);
  EXPECT_TRUE(joint);
  return world_from_joints(motion.skeleton,
                           motion.poses[static_cast<std::size_t>(frame)])[index(*joint)]
      .translation;
}

}  // namespace marey::testing
