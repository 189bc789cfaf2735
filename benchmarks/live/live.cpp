// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Measures the cost of a frame of VMC in the thread that sends or receives it. Counts
// time and allocations per frame of 22 bones. It uses the loopback network.
#include <cstdlib>
#include <vector>

#include <benchmark/benchmark.h>

#include "core/pose.h"
#include "live/vmc/vmc_body.h"
#include "live/vmc/vmc_receiver.h"
#include "live/vmc/vmc_sender.h"
#include "live/vmc/vrchat_trackers.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/program/count_allocations.h"

namespace marey::live {
namespace {

struct Scene {
  testing::Dice dice{1};
  Skeleton body = testing::with_random_axes(testing::random_humanoid(dice), dice);
  VmcBody vmc = *VmcBody::make(body);
  std::vector<Pose> poses;
  VmcPose sent;
  int frame = 0;

  Scene() {
    for (int k = 0; k < 64; ++k) poses.push_back(testing::random_pose(body, dice));
    vmc.to_vmc(poses[0], sent);
  }
  const Pose& next_pose() {
    return poses[static_cast<std::size_t>(++frame) % poses.size()];
  }
  [[nodiscard]] Timestamp time() const { return frame_time(frame, {60.0}); }
};

void count_since(long before, benchmark::State& state) {
  state.counters["allocations_per_frame"] =
      static_cast<double>(testing::allocations() - before) /
      static_cast<double>(state.iterations());
}

void pack_and_encode(benchmark::State& state) {
  Scene s;
  VmcEncoder encoder = *VmcEncoder::make();
  (void)encoder.encode(s.time(), s.sent);
  const long before = testing::allocations();
  for (auto _ : state) {
    s.vmc.to_vmc(s.next_pose(), s.sent);
    benchmark::DoNotOptimize(encoder.encode(s.time(), s.sent).data());
  }
  count_since(before, state);
}
BENCHMARK(pack_and_encode);

/// Runs both ends in one thread: the total cost of a frame, including system calls.
void send_and_receive(benchmark::State& state) {
  Scene s;
  auto receiver = *VmcReceiver::open({"127.0.0.1", 0});
  auto sender = *VmcSender::open({.targets = {{"127.0.0.1", receiver.port()}},
                                  .listen = UdpAddress{"127.0.0.1", 0}});
  VmcFrame received;
  Pose shown = s.poses[0];
  sender.send(s.time(), s.sent);
  (void)receiver.receive(received);
  const long before = testing::allocations();
  for (auto _ : state) {
    s.vmc.to_vmc(s.next_pose(), s.sent);
    sender.send(s.time(), s.sent);
    if (!receiver.receive(received)) continue;
    s.vmc.from_vmc(received.pose, shown);
    benchmark::DoNotOptimize(shown.parent_from_joint.data());
  }
  count_since(before, state);
  state.counters["lost"] =
      static_cast<double>(sender.counts()[0].sent - receiver.received().frames);
}
BENCHMARK(send_and_receive);

void vrchat_trackers(benchmark::State& state) {
  Scene s;
  VrchatTrackers trackers(s.body);
  const auto world = world_from_joints(s.body, s.poses[0]);
  (void)trackers.encode(world);
  const long before = testing::allocations();
  for (auto _ : state) benchmark::DoNotOptimize(trackers.encode(world).data());
  count_since(before, state);
}
BENCHMARK(vrchat_trackers);

}  // namespace
}  // namespace marey::live

BENCHMARK_MAIN();
