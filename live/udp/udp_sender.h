// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "live/udp/udp_address.h"
#include "live/udp/udp_socket.h"

namespace marey::live {

/// Counts of the packets for one address.
struct UdpCounts {
  std::int64_t sent = 0;     ///< Passed to the network. UDP does not report arrival.
  std::int64_t refused = 0;  ///< No receiver at the port (reported for local ports only).
  std::int64_t failed = 0;   ///< Not sent: full buffer, no network, or packet too large.
};

/// Sends packets to several addresses. Never blocks and throws nothing. An address that
/// failed is tried again with the next packet.
class UdpSender {
 public:
  /// Opens one socket per address. Errors: that of UdpSocket::to() for the first address
  /// that has one.
  [[nodiscard]] static Result<UdpSender> open(std::span<const UdpAddress> addresses);

  /// Sends the packet to every address. Allocates nothing; one or two system calls per
  /// address.
  void send(std::span<const std::uint8_t> packet);

  /// Returns the counts, in the order of the addresses given to open().
  [[nodiscard]] std::span<const UdpCounts> counts() const { return counts_; }

 private:
  std::vector<UdpSocket> sockets_;
  std::vector<UdpCounts> counts_;
};

}  // namespace marey::live
