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

/// Counts of an output.
struct OutputCounts {
  std::string name;  ///< "VMC 127.0.0.1:39539".
  live::UdpCounts counts;
};

/// Network interface of a live run: sends packets to all targets and receives commands.
/// No function blocks, and a missing receiver is no error.
class LiveOutputs {
 public:
  /// Commands are received on the port of the first stream that has one. `vrchat` are the
  /// targets of the trackers; empty if the settings request none.
  /// Errors: those of UdpSender::open() and UdpListener::open().
  [[nodiscard]] static Result<LiveOutputs> open(
      const std::vector<VmcStream>& streams,
      const std::vector<StreamTargets>& targets,
      const std::vector<live::UdpAddress>& vrchat = {});

  /// Returns the requests received since the last call. Reads at most 64 packets.
  LiveRequests& take_requests();
  void send(const LiveResult& result);
  /// Notifies all receivers of VMC that their last pose is out of date. Used while no new
  /// pose is computed.
  void send_not_tracking();
  /// Returns the counts by target.
  [[nodiscard]] std::vector<OutputCounts> counts() const;

 private:
  std::vector<StreamTargets> targets_;    ///< By stream; VRChat last, if requested.
  std::vector<live::UdpSender> senders_;  ///< Same order as targets_.
  std::size_t vmc_streams_ = 0;
  std::optional<live::UdpListener> listener_;
  std::size_t listening_stream_ = 0;
  LiveRequests requests_;
};

}  // namespace marey::app
