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

/// Where VMC's roles listen unless told otherwise: who shows a body (Marionette), and who
/// sends one and hears commands (Performer).
inline constexpr int kMarionettePort = 39539;
inline constexpr int kPerformerPort = 39540;

struct VmcSenderOptions {
  std::vector<UdpAddress> targets = {};
  /// Where commands are heard; nullopt: nowhere. Its port is told to receivers.
  std::optional<UdpAddress> listen = UdpAddress{"127.0.0.1", kPerformerPort};
  VmcEncoderOptions encoder = {};
};

/// A VMC Performer: sends the frames of one body to all targets, and does what
/// Set/Period, Set/Req ask between two frames. Belongs to one thread at a time.
class VmcSender {
 public:
  /// Errors: UdpSender::open()'s and UdpListener::open()'s (a busy port is kDevice),
  /// VmcEncoder::make()'s.
  [[nodiscard]] static Result<VmcSender> open(VmcSenderOptions options);

  /// Sends one frame; see VmcEncoder::encode(). Reads commands that came since the last
  /// one first, no more than 64 packets. Never blocks, throws nothing; allocates nothing
  /// after the first full frame.
  void send(Timestamp time, const VmcPose& pose, const VmcStatus& status = {});

  /// The calibrations asked for since the last call, which are for the caller to carry
  /// out; periods and requests are done already and not in it. The counts are of all
  /// time.
  [[nodiscard]] VmcCommands take_commands();

  /// In the order of the targets.
  [[nodiscard]] std::span<const UdpCounts> counts() const { return udp_.counts(); }
  /// Where commands are heard.
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
