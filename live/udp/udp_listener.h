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

/// Hears packets on one port.
class UdpListener {
 public:
  /// Errors: UdpSocket::at()'s.
  [[nodiscard]] static Result<UdpListener> open(const UdpAddress& address);

  /// A packet that has come, whole; nullopt when none waits. Valid until the next call.
  /// Never blocks; allocates nothing.
  [[nodiscard]] std::optional<std::span<const std::uint8_t>> receive();

  /// Sleeps until a packet waits, a signal came, or `longest` is over.
  void wait(std::chrono::milliseconds longest) const;

  [[nodiscard]] int port() const { return socket_.port(); }

 private:
  explicit UdpListener(UdpSocket socket);
  UdpSocket socket_;
  std::vector<std::uint8_t> buffer_;
};

}  // namespace marey::live
