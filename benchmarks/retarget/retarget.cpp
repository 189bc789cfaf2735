// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// How many characters can one core dress per second? Time per character of normalizing a
// source posture and expanding it on another body, and allocations per frame.
#include <cstdlib>
#include <new>
#include <vector>

#include <benchmark/benchmark.h>

#include "core/pose.h"
#include "retarget/body/normalized_skeleton.h"
#include "retarget/motion/retarget_motion.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/program/count_allocations.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::retarget {
namespace {

struct Scene {
  testing::Dice dice{1};
  Skeleton source = testing::random_humanoid(dice);
  Skeleton avatar = testing::with_vertebrae(testing::giant(), 5);
  BodyMap from = *map_body(source);
  BodyMap to = *map_body(avatar);
  std::vector<std::vector<RigidTransform>> source_frames;
  std::vector<RigidTransform> avatar_frames =
      std::vector<RigidTransform>(avatar.joints.size());
  NormalizedPose posture;
  Pose out = rest_pose(avatar);

  Scene() {
    for (int k = 0; k < 256; ++k) {
      const Pose pose = testing::random_pose(source, dice);
      source_frames.push_back(world_from_joints(source, pose));
    }
  }
};

void normalize_and_expand(benchmark::State& state) {
  Scene s;
  std::size_t k = 0;
  const long before = testing::allocations();
  for (auto _ : state) {
    normalize(s.from, s.source_frames[k++ % s.source_frames.size()], s.posture);
    expand(s.posture, s.avatar, s.to, s.avatar_frames, s.out);
    benchmark::DoNotOptimize(s.out.parent_from_joint.data());
  }
  state.counters["allocations_per_frame"] =
      static_cast<double>(testing::allocations() - before) /
      static_cast<double>(state.iterations());
}
BENCHMARK(normalize_and_expand);

void expand_only(benchmark::State& state) {
  Scene s;
  normalize(s.from, s.source_frames[0], s.posture);
  for (auto _ : state) {
    expand(s.posture, s.avatar, s.to, s.avatar_frames, s.out);
    benchmark::DoNotOptimize(s.out.parent_from_joint.data());
  }
}
BENCHMARK(expand_only);

// A whole motion, contacts and ground included; time per frame.
void retarget_a_walk(benchmark::State& state) {
  const Motion walk = testing::synthetic_walk(600, 60.0).motion;
  const Skeleton avatar = testing::child();
  for (auto _ : state) benchmark::DoNotOptimize(retarget_motion(walk, avatar));
  state.SetItemsProcessed(state.iterations() * 600);
}
BENCHMARK(retarget_a_walk)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace marey::retarget

BENCHMARK_MAIN();
