// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/app/jump/jump_scene.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "app/motion/retarget_files.h"
#include "core/character_spec.h"
#include "recordings/motion/npz.h"
#include "retarget/body/body_map.h"
#include "retarget/body/place_masses.h"
#include "tests/support/program/paths.h"
#include "tests/support/simulation/synthetic_walk.h"
#include "tests/support/truth/momentum_judge.h"

namespace marey::testing {

namespace fs = std::filesystem;

JumpScene::JumpScene() {
  EXPECT_TRUE(recordings::write_npz(folder_ / "walk.npz",
                                    synthetic_walk(360, 120.0, 0.002, 0.0005).motion));
  const fs::path source = shared_data() / "mocap/cmu_asfamc/02_04.amc";
  if (!fs::exists(source)) return;
  const auto read = app::read_motion(app::BodyFile(source));
  EXPECT_TRUE(read) << source;
  has_jump_ = read && recordings::write_npz(folder_ / "jump.npz", read->motion);
}

ProgramRun JumpScene::jump(const std::string& motion,
                           const std::string& out,
                           const std::vector<std::string>& more) const {
  std::vector<std::string> words{"--progress", "none", "jump", motion, "--out", out};
  words.insert(words.end(), more.begin(), more.end());
  return run_program(program(), words, {.folder = folder_.path(), .interrupt_at = {}});
}

nlohmann::json JumpScene::figures(const std::string& motion,
                                  const std::string& out,
                                  std::vector<std::string> more) const {
  more.emplace_back("--json");
  const ProgramRun run = jump(motion, out, more);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  nlohmann::json json = nlohmann::json::parse(run.out, nullptr, false);
  EXPECT_TRUE(json.is_object()) << run.out;
  if (!json.is_object()) return {{"figures", nlohmann::json::object()}};
  return json;
}

Motion JumpScene::motion(const std::string& name) const {
  const auto read = recordings::read_npz(folder_ / name);
  EXPECT_TRUE(read) << name;
  return read ? read->motion : Motion{};
}

void JumpScene::write_part(const std::string& name, int first, int last, int step) const {
  Motion part = motion("jump.npz");
  std::vector<Pose> poses;
  for (int t = first; t <= last; t += step) {
    poses.push_back(part.poses.at(static_cast<std::size_t>(t)));
  }
  part.poses = std::move(poses);
  part.rate.hz /= step;
  EXPECT_TRUE(recordings::write_npz(folder_ / name, part));
}

std::vector<std::string> JumpScene::files() const {
  std::vector<std::string> out;
  for (const auto& entry : fs::directory_iterator(folder_.path())) {
    out.push_back(entry.path().filename().string());
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<double> judged_heights(const Motion& motion) {
  std::vector<double> out;
  const auto map = retarget::map_body(motion.skeleton);
  EXPECT_TRUE(map) << (map ? "" : map.error().message());
  if (!map) return out;
  const auto masses = retarget::place_masses(motion.skeleton, *map, MassSpec{});
  EXPECT_TRUE(masses);
  if (!masses) return out;
  for (const Pose& pose : motion.poses) {
    out.push_back(judged_com(motion.skeleton, *masses, pose).y);
  }
  return out;
}

}  // namespace marey::testing
