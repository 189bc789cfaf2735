// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/base/time.h"
#include "live/udp/udp_address.h"
#include "live/udp/udp_listener.h"
#include "live/udp/udp_sender.h"
#include "live/vmc/vmc_commands.h"
#include "live/vmc/vmc_encoder.h"
#include "live/vmc/vmc_pose.h"

namespace marey::live {

/// Default ports of VMC's roles: the Marionette shows a body; the Performer sends one and
/// receives commands.
inline constexpr int kMarionettePort = 39539;
inline constexpr int kPerformerPort = 39540;

struct VmcSenderOptions {
  std::vector<UdpAddress> targets = {};
  /// Address at which commands are received; nullopt: none. Its port is sent to
  /// receivers.
  std::optional<UdpAddress> listen = UdpAddress{"127.0.0.1", kPerformerPort};
  VmcEncoderOptions encoder = {};
};

/// A VMC Performer: sends the frames of one body to all targets, and applies Set/Period
/// and Set/Req between two frames. Used by one thread at a time.
class VmcSender {
 public:
  /// Opens the sockets. Errors: those of UdpSender::open() and UdpListener::open() (a
  /// busy port is kDevice) and of VmcEncoder::make().
  [[nodiscard]] static Result<VmcSender> open(VmcSenderOptions options);

  /// Sends one frame; see VmcEncoder::encode(). Reads up to 64 waiting command packets
  /// first. Never blocks, throws nothing; allocates nothing after the first full frame.
  void send(Timestamp time, const VmcPose& pose, const VmcStatus& status = {});

  /// Returns the calibrations requested since the last call; the caller carries them out.
  /// Periods and requests are already applied and not included. The counts are totals
  /// since open().
  [[nodiscard]] VmcCommands take_commands();

  /// Returns the counts, in the order of the targets.
  [[nodiscard]] std::span<const UdpCounts> counts() const { return udp_.counts(); }
  /// Returns the port at which commands are received; nullopt: none.
  [[nodiscard]] std::optional<int> listen_port() const;

 private:
  VmcSender(UdpSender udp, std::optional<UdpListener> listener, VmcEncoder encoder);
  void receive_commands();

  UdpSender udp_;
  std::optional<UdpListener> listener_;
  VmcEncoder encoder_;
  VmcCommands commands_;
};

}  // namespace marey::live
