// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/live_chain/live_chain.h"
#include "app/live_chain/live_streams.h"
#include "live/udp/udp_listener.h"
#include "live/udp/udp_sender.h"

namespace marey::app {

/// How an output fares.
struct OutputCounts {
  std::string name;  ///< "VMC 127.0.0.1:39539".
  live::UdpCounts counts;
};

/// The network's end of a live run: packets to all targets, commands from who sends them.
/// Nothing here blocks, or stops because somebody is gone.
class LiveOutputs {
 public:
  /// Commands are heard on the port of the first stream that has one. `vrchat`: where
  /// trackers go; empty: the settings want none.
  /// Errors: UdpSender::open()'s and UdpListener::open()'s.
  [[nodiscard]] static Result<LiveOutputs> open(
      const std::vector<VmcStream>& streams,
      const std::vector<StreamTargets>& targets,
      const std::vector<live::UdpAddress>& vrchat = {});

  /// What was asked for since the last call. Reads no more than 64 packets.
  LiveRequests& take_requests();
  void send(const LiveResult& result);
  /// Tells all receivers of VMC that the pose they have is not to be trusted: there is no
  /// new one that could say so.
  void send_not_tracking();
  /// By target.
  [[nodiscard]] std::vector<OutputCounts> counts() const;

 private:
  std::vector<StreamTargets> targets_;  ///< By stream; VRChat's last, if there is any.
  std::vector<live::UdpSender> senders_;  ///< Likewise.
  std::size_t vmc_streams_ = 0;
  std::optional<live::UdpListener> listener_;
  std::size_t listening_stream_ = 0;
  LiveRequests requests_;
};

}  // namespace marey::app
