// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/engine/made_base.h"

#include <string>
#include <utility>
#include <vector>

#include "engine/clips/make_clip.h"

#include "core/base/smooth_step.h"
#include "retarget/character/make_character.h"
#include "retarget/contacts/detect_contacts.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::engine {
namespace {

constexpr int kCycle = 66;  // Frames of 1.1 s at 60 Hz.

ClipSource made_source(std::string name, Motion motion, bool loops) {
  ClipSource source;
  source.name = std::move(name);
  source.map = *retarget::map_body(motion.skeleton);
  source.contacts = retarget::detect_contacts(motion, source.map);
  source.motion = std::move(motion);
  source.loops = loops;
  return source;
}

// Frames of the walk from its second cycle on, so that the contacts at both ends are
// those of a walk that goes on.
Motion part_of_walk(int frames, double hz) {
  Motion motion = testing::synthetic_walk(3 * kCycle, 60.0).motion;
  motion.poses.erase(motion.poses.begin(), motion.poses.begin() + kCycle);
  motion.poses.resize(static_cast<std::size_t>(frames));
  motion.rate = {hz};
  return motion;
}

// One posture of the walk whose right arm throws: the ball leaves after one second.
Motion made_throw() {
  constexpr int kFrames = 241;  // At 120 Hz.
  Motion motion = part_of_walk(1, 120.0);
  const auto map = *retarget::map_body(motion.skeleton);
  const std::size_t upper = index(map.limbs[1]->upper);
  const std::size_t lower = index(map.limbs[1]->lower);
  const std::size_t hand = index(map.limbs[1]->end);
  const Pose still = motion.poses.front();
  motion.poses.clear();
  for (int i = 0; i < kFrames; ++i) {
    const double swings = smooth_step((i / 120.0 - 0.78) / 0.4);
    const double comes_back = smooth_step((i / 120.0 - 1.3) / 0.6);
    const double share = swings * (1.0 - comes_back);
    Pose pose = still;
    pose.parent_from_joint[upper] =
        glm::angleAxis(-0.2 + 1.6 * share, glm::dvec3(0, 1, 0)) *
        glm::angleAxis(-0.3 + 0.5 * share, glm::dvec3(0, 0, 1));
    pose.parent_from_joint[lower] =
        glm::angleAxis(1.1 - 0.3 * share, glm::dvec3(0, 1, 0));
    pose.parent_from_joint[hand] =
        glm::angleAxis(-0.3 + 0.6 * share, glm::dvec3(0, 1, 0));
    motion.poses.push_back(pose);
  }
  return motion;
}

}  // namespace

const Skeleton& made_skeleton() {
  static const Skeleton kSkeleton = testing::synthetic_walk(2, 60.0).motion.skeleton;
  return kSkeleton;
}

std::shared_ptr<const MotionBase> made_base() {
  Motion still = part_of_walk(1, 60.0);
  const auto map = *retarget::map_body(still.skeleton);
  const std::size_t arm = index(map.limbs[1]->upper);
  still.poses[0].parent_from_joint[arm] =
      glm::angleAxis(0.7, glm::dvec3(0, 1, 0)) * still.poses[0].parent_from_joint[arm];
  still.poses.resize(121, still.poses.front());
  std::vector<ClipSource> sources{
      made_source("walk", part_of_walk(kCycle + 1, 60.0), true),
      made_source("stroll", part_of_walk(kCycle + 1, 48.0), true),
      made_source("steps", part_of_walk(2 * kCycle, 60.0), false),
      made_source("still", std::move(still), false),
      made_source("throw", made_throw(), false)};
  sources[3].annotations.notes.push_back({"arrive", 1.0, 1.0});
  sources[4].annotations.notes.push_back({"release", 1.0, 1.0});
  return *MotionBase::make(*make_moves(sources));
}

CharacterSpec made_character(const Skeleton& skeleton) {
  CharacterSpec spec;
  spec.map = *retarget::map_body(skeleton);
  spec.character = *retarget::make_character("ann", skeleton, spec.map);
  return spec;
}

}  // namespace marey::engine
