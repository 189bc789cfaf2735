// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/fuzz_seeds_osc.h"

#include <chrono>
#include <span>

#include "live/vmc/osc_writer.h"
#include "live/vmc/vmc_encoder.h"

namespace marey::fuzz {
namespace {

using namespace std::chrono_literals;
using namespace std::string_literals;

void append(std::string& input, const std::string& packet) {
  input += static_cast<char>(packet.size() >> 8);
  input += static_cast<char>(packet.size());
  input += packet;
}

void append(std::string& input, std::span<const std::span<const std::uint8_t>> packets) {
  for (const auto packet : packets) {
    append(input, std::string(packet.begin(), packet.end()));
  }
}

}  // namespace

std::string osc_pose() {
  live::VmcPose pose;
  for (const auto bone :
       {live::UnityBone::kHips, live::UnityBone::kLeftFoot, live::UnityBone::kJaw}) {
    pose.set(bone, {{0.1, 0.9, -0.2}, {0.6, 0.0, 0.8, 0.0}});
  }
  auto whole = *live::VmcEncoder::make();
  auto split = *live::VmcEncoder::make({.mtu_bytes = 250});
  std::string input;
  for (int frame = 0; frame < 3; ++frame) {
    append(input, whole.encode(frame * 10ms, pose));
    append(input, split.encode(frame * 10ms, pose));
  }
  return input;
}

std::string osc_commands() {
  live::OscWriter writer;
  writer.begin("/VMC/Ext/Set/Period", "iii").add(1).add(2).add(3);
  writer.begin("/VMC/Ext/Set/Req", "");
  writer.begin("/VMC/Ext/Set/Calib/Ready", "");
  writer.begin("/VMC/Ext/Set/Calib/Exec", "i").add(2);
  std::string input;
  append(input, writer.packets());
  append(input, "/T\0\0"s);
  append(input,
         "/VMC/Ext/T\0\0,dhTFNI[]sbtcrmS\0"s + std::string(16, '\0') +
             "abc\0\0\0\0\2xy\0\0"s + std::string(20, '\0') + "d\0\0\0"s);
  const std::string inner = "#bundle\0\0\0\0\0\0\0\0\1\0\0\0\4/a\0\0"s;
  append(input, "#bundle\0\0\0\0\0\0\0\0\1\0\0\0\x18"s + inner);
  return input;
}

}  // namespace marey::fuzz
