// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Receives the body of another program by VMC and shows it on a body of its own.
//
//     vmc_in HOST:PORT SECONDS
//
// Prints the lowest and the highest place of the left wrist.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "core/skeleton.h"
#include "live/udp/udp_address.h"
#include "live/vmc/vmc_body.h"
#include "live/vmc/vmc_receiver.h"

using namespace marey;

namespace {

int fail(const Error& error) {
  std::fprintf(stderr, "error: %s\n", error.message().c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return fail(bad_input("", "arguments are missing", "see the source"));
  const auto address = live::parse_udp_address(argv[1], live::kMarionettePort);
  if (!address) return fail(address.error());
  auto receiver = live::VmcReceiver::open(*address);
  if (!receiver) return fail(receiver.error());

  const Skeleton skeleton = make_humanoid(average_proportions(1.75));
  const auto body = live::VmcBody::make(skeleton);
  if (!body) return fail(body.error());
  const std::size_t wrist = index(*skeleton.find(HumanBone::kLeftHand));

  const std::chrono::duration<double> duration(std::atof(argv[2]));
  const auto begin = std::chrono::steady_clock::now();
  live::VmcFrame frame;
  Pose pose;
  double low_m = 1e9;
  double high_m = -1e9;
  while (std::chrono::steady_clock::now() - begin < duration) {
    receiver->wait(std::chrono::milliseconds(50));
    while (receiver->receive_next(frame)) {
      body->from_vmc(frame.pose, pose);
      const double height_m = world_from_joints(skeleton, pose)[wrist].translation.y;
      low_m = std::min(low_m, height_m);
      high_m = std::max(high_m, height_m);
    }
  }
  if (receiver->received().frames == 0) {
    return fail({Errc::kDevice, argv[1], "no body was received", "start its sender"});
  }
  std::printf("low_m %.4f\nhigh_m %.4f\n", low_m, high_m);
  return 0;
}
