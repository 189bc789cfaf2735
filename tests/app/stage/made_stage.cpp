// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/app/stage/made_stage.h"

#include <utility>
#include <vector>

#include "engine/clips/make_clip.h"

#include "app/stage/run/stage_bodies.h"
#include "core/base/smooth_step.h"
#include "recordings/scene/read_scene.h"
#include "retarget/contacts/detect_contacts.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::app::testing {
namespace {

constexpr double kHz = 60.0;

/// The rest pose with hanging arms, standing on the floor.
Motion standing(int frames) {
  Motion motion = marey::testing::synthetic_walk(2, kHz).motion;
  const double hips_m = rest_pose(motion.skeleton).root_in_world.y;
  Pose pose = rest_pose(motion.skeleton);
  pose.root_in_world = {0.0, hips_m, 0.0};
  const auto map = *retarget::map_body(motion.skeleton);
  for (const std::size_t side : {0U, 1U}) {
    const std::size_t arm = index(map.limbs[side]->upper);
    pose.parent_from_joint[arm] =
        glm::angleAxis(side == 0 ? -1.2 : 1.2, glm::dvec3(0.0, 0.0, 1.0)) *
        pose.parent_from_joint[arm];
  }
  motion.poses.assign(static_cast<std::size_t>(frames), pose);
  return motion;
}

Motion waving() {
  Motion motion = standing(61);
  const auto map = *retarget::map_body(motion.skeleton);
  const std::size_t arm = index(map.limbs[1]->upper);
  for (std::size_t i = 0; i < motion.poses.size(); ++i) {
    const double s = static_cast<double>(i) / 60.0;
    const double share = smooth_step(2.5 * s) * (1.0 - smooth_step(2.5 * (s - 0.6)));
    motion.poses[i].parent_from_joint[arm] =
        glm::angleAxis(-0.4 * share, glm::dvec3(0.0, 0.0, 1.0)) *
        motion.poses[i].parent_from_joint[arm];
  }
  return motion;
}

engine::ClipSource source_of(std::string name, Motion motion, bool loops) {
  engine::ClipSource source;
  source.name = std::move(name);
  source.map = *retarget::map_body(motion.skeleton);
  source.contacts = retarget::detect_contacts(motion, source.map);
  source.motion = std::move(motion);
  source.loops = loops;
  return source;
}

std::string whole_text(const std::string& text) {
  return "format = 1\nname = \"made\"\nduration_s = 3.0\nbase = \"none\"\n" + text;
}

}  // namespace

std::shared_ptr<const engine::MotionBase> made_stage_base() {
  std::vector<engine::ClipSource> sources{source_of("idle", standing(61), true),
                                          source_of("wave", waving(), false)};
  sources[1].annotations.notes.push_back({"impact", 0.5, 0.5});
  return *engine::MotionBase::make(*engine::make_moves(sources));
}

SceneRunInput made_stage_input(const std::string& text) {
  SceneRunInput input;
  input.scene = *recordings::parse_scene(whole_text(text), "made.toml");
  input.base = made_stage_base();
  input.bodies = read_stage_cast(input.scene)->bodies;
  return input;
}

std::string refusal_of(const std::string& text) {
  const auto run = SceneRun::make(made_stage_input(text));
  return run ? std::string() : run.error().message();
}

SceneRun played(SceneRunInput input) {
  SceneRun run = *SceneRun::make(std::move(input));
  while (!run.is_over()) run.advance();
  return run;
}

}  // namespace marey::app::testing
