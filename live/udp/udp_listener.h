// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "live/udp/udp_address.h"
#include "live/udp/udp_socket.h"

namespace marey::live {

/// Receives packets on one port.
class UdpListener {
 public:
  /// Opens the port. Errors: those of UdpSocket::at().
  [[nodiscard]] static Result<UdpListener> open(const UdpAddress& address);

  /// Returns the next received packet, complete; nullopt if there is none. Valid until
  /// the next call. Never blocks; allocates nothing.
  [[nodiscard]] std::optional<std::span<const std::uint8_t>> receive();

  /// Blocks until a packet has arrived, a signal arrives, or `longest` has passed.
  void wait(std::chrono::milliseconds longest) const;

  [[nodiscard]] int port() const { return socket_.port(); }

 private:
  explicit UdpListener(UdpSocket socket);
  UdpSocket socket_;
  std::vector<std::uint8_t> buffer_;
};

}  // namespace marey::live
