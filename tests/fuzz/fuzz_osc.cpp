// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The input is packets, each after its size in two bytes, the highest first; what is left
// is the last packet.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/base/assert.h"
#include "live/vmc/osc_parse.h"
#include "live/vmc/vmc_assembler.h"
#include "live/vmc/vmc_commands.h"

namespace {

using namespace marey;
using namespace marey::live;

using Bytes = std::span<const std::uint8_t>;

Bytes next_packet(Bytes& rest) {
  if (rest.size() < 2) return std::exchange(rest, {});
  const std::size_t size = std::min<std::size_t>(rest[0] << 8 | rest[1], rest.size() - 2);
  const Bytes packet = rest.subspan(2, size);
  rest = rest.subspan(2 + size);
  return packet;
}

/// Every argument is one of the readers', or none's and read no further.
void read_arguments(OscArguments arguments) {
  while (arguments.read_int() || arguments.read_number() || arguments.read_text()) {
  }
}

void parse(Bytes packet) {
  int messages = 0;
  const bool sound = parse_osc(packet, [&](const OscMessage& message) {
    ++messages;
    MAREY_ASSERT(message.address.starts_with('/'));
    read_arguments(message.arguments());
  });
  MAREY_ASSERT(sound == is_osc(packet));
  MAREY_ASSERT(sound || messages == 0);
}

void check(const VmcFrame& frame) {
  MAREY_ASSERT(frame.pose.has.any());
  MAREY_ASSERT(!frame.time_s || std::isfinite(*frame.time_s));
  for (std::size_t i = 0; i < kUnityBoneCount; ++i) {
    if (!frame.pose.has[i]) continue;
    const UnityTransform& local = frame.pose.local[i];
    MAREY_ASSERT(std::abs(glm::length(local.rotation) - 1.0) < 1e-9);
    MAREY_ASSERT(glm::length(local.position) <= 10e3);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes rest(data, size);
  VmcAssembler assembler;
  VmcCommands commands;
  VmcFrame frame;
  while (!rest.empty()) {
    const Bytes packet = next_packet(rest);
    parse(packet);
    read_commands(packet, commands);
    assembler.take(packet);
    if (assembler.take_frame(frame)) check(frame);
  }
  return 0;
}
