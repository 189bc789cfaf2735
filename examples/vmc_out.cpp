// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Sends a body that waves with its left arm to a receiver of VMC, at 60 frames a second.
//
//     vmc_out HOST:PORT SECONDS
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "core/skeleton.h"
#include "live/udp/udp_address.h"
#include "live/vmc/vmc_body.h"
#include "live/vmc/vmc_sender.h"

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
  const double duration_s = std::atof(argv[2]);

  const Skeleton skeleton = make_humanoid(average_proportions(1.75));
  const auto body = live::VmcBody::make(skeleton);
  if (!body) return fail(body.error());
  live::VmcSenderOptions options;
  options.targets = {*address};
  options.listen = std::nullopt;
  auto sender = live::VmcSender::open(options);
  if (!sender) return fail(sender.error());

  constexpr FrameRate kRate{60.0};
  const std::size_t arm = index(*skeleton.find(HumanBone::kLeftUpperArm));
  const auto begin = std::chrono::steady_clock::now();
  Pose pose = rest_pose(skeleton);
  live::VmcPose packet;
  int frame = 0;
  for (; frame < duration_s * kRate.hz; ++frame) {
    // From 0 to 60 degrees above the horizontal and back, once a second.
    const double swing = 0.5 - 0.5 * std::cos(2.0 * std::acos(-1.0) * frame / kRate.hz);
    pose.parent_from_joint[arm] =
        glm::angleAxis(swing * std::acos(-1.0) / 3.0, glm::dvec3(0.0, 0.0, 1.0));
    body->to_vmc(pose, packet);
    sender->send(frame_time(frame, kRate), packet);
    std::this_thread::sleep_until(begin + frame_time(frame + 1, kRate));
  }
  std::printf("frames %d\npackets %lld\n",
              frame,
              static_cast<long long>(sender->counts().front().sent));
  return 0;
}
