// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/vmc/vmc_commands.h"

#include "live/vmc/osc_parse.h"

namespace marey::live {
namespace {

/// Applies the message; returns false if it is not a command or its arguments are wrong.
bool apply(const OscMessage& message, VmcCommands& commands) {
  OscArguments arguments = message.arguments();
  if (message.address == "/VMC/Ext/Set/Req") {
    commands.info = true;
    return true;
  }
  if (message.address == "/VMC/Ext/Set/Calib/Ready") {
    commands.calibration_ready = true;
    return true;
  }
  if (message.address == "/VMC/Ext/Set/Calib/Exec") {
    const auto mode = arguments.read_int();
    if (mode) commands.calibration = *mode;
    return mode.has_value();
  }
  if (message.address != "/VMC/Ext/Set/Period") return false;
  const auto status = arguments.read_int();
  const auto root = arguments.read_int();
  const auto bone = arguments.read_int();
  if (!status || !root || !bone) return false;
  // The periods of blend shapes, camera and devices follow; marey sends none of them.
  commands.periods = VmcPeriods{*status, *root, *bone};
  return true;
}

}  // namespace

void read_commands(std::span<const std::uint8_t> packet, VmcCommands& commands) {
  const bool sound = parse_osc(packet, [&commands](const OscMessage& message) {
    ++(apply(message, commands) ? commands.applied : commands.ignored);
  });
  if (!sound) ++commands.malformed;
}

}  // namespace marey::live
