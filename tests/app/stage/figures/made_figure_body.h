// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "engine/clips/sample_clip.h"
#include <gtest/gtest.h>

#include "app/stage/figures/figure_body.h"
#include "core/human/average_proportions.h"
#include "retarget/body/normalized_skeleton.h"
#include "retarget/character/make_character.h"

namespace marey::app {

/// A body of 1.75 m that stands in its rest pose for 2 s at 60 Hz. Tests displace it.
struct MadeFigureBody {
  MadeFigureBody() {
    Skeleton skeleton = make_humanoid(average_proportions(1.75));
    map = *retarget::map_body(skeleton);
    character = *retarget::make_character("made", std::move(skeleton), map);
    for (int i = 0; i < 120; ++i) {
      times_s.push_back(i / 60.0);
      poses.push_back(rest_pose(character.skeleton));
    }
    references = poses;
    stands.assign(poses.size(), {true, true});
  }

  [[nodiscard]] FigureBody body() const {
    return {"made", &character, &map, times_s, poses, references, stands, {}};
  }
  void turn(std::size_t step, HumanBone bone, const glm::dquat& by) {
    glm::dquat& rotation =
        poses[step].parent_from_joint[index(*map.joint_of[index(bone)])];
    rotation = by * rotation;
  }
  [[nodiscard]] glm::dvec3 place(HumanBone bone) const {
    return world_from_joints(character.skeleton,
                             references[0])[index(*map.joint_of[index(bone)])]
        .translation;
  }

  Character character;
  retarget::BodyMap map;
  std::vector<double> times_s;
  std::vector<Pose> poses;
  std::vector<Pose> references;
  std::vector<std::array<bool, 2>> stands;
};

/// A clip of that many seconds at 60 Hz in which the body leans to both sides.
inline MotionClip leaning_clip(const MadeFigureBody& made,
                               double duration_s,
                               double lean_hz,
                               double lean_rad,
                               double speed_m_s) {
  MotionClip clip;
  clip.name = "lean";
  clip.rate_hz = 60.0F;
  clip.loops = true;
  clip.leg_length_m = static_cast<float>(made.map.leg_length_m);
  std::vector<RigidTransform> joints;
  const int frames = static_cast<int>(std::lround(duration_s * 60.0));
  for (int i = 0; i <= frames; ++i) {
    const double time_s = i / 60.0;
    Pose pose = made.references[0];
    pose.root_in_world.z += speed_m_s * time_s;
    const double angle = lean_rad * std::sin(6.283185307179586 * lean_hz * time_s);
    pose.parent_from_joint[index(*made.map.joint_of[index(HumanBone::kSpine)])] =
        glm::angleAxis(angle, glm::dvec3(0.0, 0.0, 1.0));
    const retarget::NormalizedPose normalized =
        retarget::normalize(made.character.skeleton, made.map, pose);
    BlendPosture posture;
    engine::RootPlace root;
    engine::from_normalized(
        normalized, PostureLayout{}, made.map.leg_length_m, 0.0, posture, root);
    clip.frames.push_back(posture);
    clip.path.push_back({static_cast<float>(root.x_m / made.map.leg_length_m),
                         static_cast<float>(root.z_m / made.map.leg_length_m),
                         static_cast<float>(root.heading_rad)});
  }
  return clip;
}

}  // namespace marey::app
