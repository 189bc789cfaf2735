// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "live/vmc/vmc_encoder.h"

namespace marey::live {

/// Commands received by a VMC Performer (/VMC/Ext/Set/...), and counts of the messages.
struct VmcCommands {
  std::optional<VmcPeriods> periods;  ///< Set/Period; the last one counts.
  bool info = false;                  ///< Set/Req: send the low-rate messages at once.
  bool calibration_ready = false;     ///< Set/Calib/Ready: stand in the T-pose.
  std::optional<int> calibration;  ///< Set/Calib/Exec: 0 normal, 1 and 2 mixed reality.
  std::int64_t applied = 0;        ///< Messages of the four commands above.
  std::int64_t ignored = 0;        ///< Other messages, and commands of wrong arguments.
  std::int64_t malformed = 0;      ///< Packets that are not OSC.
};

/// Adds the commands of a packet to `commands`. Surplus arguments are ignored.
/// Cost: linear in bytes; allocates nothing.
void read_commands(std::span<const std::uint8_t> packet, VmcCommands& commands);

}  // namespace marey::live
