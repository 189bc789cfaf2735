// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/app/stage/live/live_scene.h"

#include <utility>

#include "engine/clips/make_clip.h"
#include <gtest/gtest.h>

#include "app/stage/run/stage_bodies.h"
#include "recordings/scene/read_scene.h"
#include "retarget/contacts/detect_contacts.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::app {
namespace {

constexpr const char* kText = R"(
format = 1
name = "three"
duration_s = 2.0
base = "moves.marey"
[[group]]
id = "crowd"
count = 3
stature_m = [1.2, 1.8]
spacing_m = [2.0, 2.0]
heading_deg = 90.0
idle = "still"
[[target]]
id = "left"
path = "fixed"
frame = "body"
for_stature_m = 1.75
position_m = [0.30, 1.15, 0.35]
drag = true
[[target]]
id = "cup"
path = "lissajous"
middle_m = [0.0, 1.0, 3.0]
amplitude_m = [0.2, 0.0, 0.0]
frequency_hz = [1.0, 0.0, 0.0]
drag = true
[[target]]
id = "wall"
path = "fixed"
position_m = [0.0, 1.0, 9.0]
[[at]]
time_s = 0.0
body = "crowd"
do = "constrain"
segment = "leftHand"
target = "left"
[[out.vmc]]
body = "crowd.2"
port = 39540
[[measure]]
kind = "wrist_error"
body = "crowd"
segment = "leftHand"
target = "left"
max_mm = 1.0
[[measure]]
kind = "feet_slide"
body = "crowd"
max_mm = 0.1
)";

/// A base of one clip: a person stands still for two seconds.
std::shared_ptr<const engine::MotionBase> base_of_still() {
  engine::ClipSource still;
  still.name = "still";
  still.motion = testing::synthetic_walk(1, 60.0).motion;
  still.motion.poses.resize(120, still.motion.poses.front());
  still.map = *retarget::map_body(still.motion.skeleton);
  still.contacts = retarget::detect_contacts(still.motion, still.map);
  auto moves = engine::make_moves({&still, 1});
  EXPECT_TRUE(moves) << moves.error().message();
  auto base = engine::MotionBase::make(*std::move(moves));
  EXPECT_TRUE(base) << base.error().message();
  return *std::move(base);
}

}  // namespace

SceneRunInput live_scene() {
  SceneRunInput input;
  auto scene = recordings::parse_scene(kText, "three.toml");
  EXPECT_TRUE(scene) << scene.error().message();
  input.scene = *std::move(scene);
  auto cast = read_stage_cast(input.scene);
  EXPECT_TRUE(cast) << cast.error().message();
  input.bodies = std::move(cast->bodies);
  input.base = base_of_still();
  return input;
}

}  // namespace marey::app
