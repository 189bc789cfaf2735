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

/// What became of the packets for one address.
struct UdpCounts {
  std::int64_t sent = 0;     ///< Handed to the network. Whether they arrive nobody knows.
  std::int64_t refused = 0;  ///< Nobody listens there (known of the machine's own ports).
  std::int64_t failed = 0;   ///< Not sent: a full buffer, no network, too large.
};

/// Sends packets to several addresses. Never blocks, throws nothing, gives up on nobody:
/// an address that is gone is tried again with the next packet.
class UdpSender {
 public:
  /// Errors: UdpSocket::to()'s, of the first address that has one.
  [[nodiscard]] static Result<UdpSender> open(std::span<const UdpAddress> addresses);

  /// The packet to every address. Allocates nothing; one or two system calls an address.
  void send(std::span<const std::uint8_t> packet);

  /// In the order of open()'s addresses.
  [[nodiscard]] std::span<const UdpCounts> counts() const { return counts_; }

 private:
  std::vector<UdpSocket> sockets_;
  std::vector<UdpCounts> counts_;
};

}  // namespace marey::live
