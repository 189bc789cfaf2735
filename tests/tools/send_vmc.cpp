// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// send_vmc PORT COUNT: sends COUNT frames of a wild motion of 22 bones to a program of
// this machine that listens on the UDP port, as fast as it reads them. The kernel's table
// of sockets contains the number of unread bytes, so no packet is lost on the way. Ends
// when the last frame is read. Exits with 1 when no program listens, or it reads nothing
// for ten seconds.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>
#include <thread>

#include "core/human/average_proportions.h"
#include "core/skeleton.h"
#include "live/vmc/vmc_body.h"
#include "live/vmc/vmc_sender.h"
#include "tests/recordings/wild_motion.h"

namespace {

using namespace marey;
using namespace std::chrono_literals;

// Half of Linux's default receive buffer of a socket.
constexpr long kMaxWaiting_bytes = 100000;

/// Returns the unread bytes of all sockets on the port; nullopt: there is no socket.
std::optional<long> waiting_bytes(int port) {
  std::optional<long> waiting;
  for (const char* table : {"/proc/net/udp", "/proc/net/udp6"}) {
    std::ifstream file(table);
    std::string line;
    std::getline(file, line);
    while (std::getline(file, line)) {
      // "sl: address:port remote:port state tx_queue:rx_queue ..."; hexadecimal.
      std::istringstream words(line);
      std::string slot;
      std::string local;
      std::string remote;
      std::string state;
      std::string queues;
      words >> slot >> local >> remote >> state >> queues;
      const auto hex = [](const std::string& text) {
        return std::strtol(text.c_str(), nullptr, 16);
      };
      if (hex(local.substr(local.rfind(':') + 1)) != port) continue;
      waiting = waiting.value_or(0) + hex(queues.substr(queues.rfind(':') + 1));
    }
  }
  return waiting;
}

/// Waits until no more than `bytes` are unread; false when that takes too long.
bool wait_for(int port, long bytes) {
  for (int i = 0; i < 10000; ++i) {
    const auto waiting = waiting_bytes(port);
    if (waiting && *waiting <= bytes) return true;
    std::this_thread::sleep_for(1ms);
  }
  std::cerr << "no program reads from port " << port << "\n";
  return false;
}

int send(int port, int count) {
  if (!wait_for(port, 0)) return 1;
  const Motion motion =
      recordings::wild_motion(make_humanoid(average_proportions(1.75)), 50);
  auto sender =
      live::VmcSender::open({.targets = {{"127.0.0.1", port}}, .listen = std::nullopt});
  const auto body = live::VmcBody::make(motion.skeleton);
  if (!sender || !body) return 1;
  live::VmcPose sent;
  for (int frame = 0; frame < count; ++frame) {
    if (frame % 10 == 0 && !wait_for(port, kMaxWaiting_bytes)) return 1;
    const auto k = static_cast<std::size_t>(frame) % motion.poses.size();
    body->to_vmc(motion.poses[k], sent);
    sender->send(frame_time(frame, {60.0}), sent);
  }
  return wait_for(port, 0) && sender->counts()[0].sent == count ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: send_vmc PORT COUNT\n";
    return 2;
  }
  return send(std::atoi(argv[1]), std::atoi(argv[2]));
}
