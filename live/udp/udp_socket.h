// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "core/base/result.h"
#include "live/udp/udp_address.h"

namespace marey::live {

/// A non-blocking UDP socket. The destructor closes it.
class UdpSocket {
 public:
  UdpSocket() = default;
  UdpSocket(UdpSocket&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  UdpSocket& operator=(UdpSocket&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~UdpSocket();

  /// Opens a socket that sends to `address`; broadcast addresses are allowed. Resolves
  /// the name, which may take seconds. IPv4 addresses of the host are tried before IPv6.
  /// Errors: the host does not exist (kBadInput); names cannot be resolved, or there is
  /// no route to the address (kDevice).
  [[nodiscard]] static Result<UdpSocket> to(const UdpAddress& address);

  /// Opens a socket that receives packets for `address`: "127.0.0.1" accepts packets from
  /// this machine only, "0.0.0.0" from any machine. Port 0: any free port.
  /// Errors: the host is not an address of this machine (kBadInput); the port is in use
  /// or reserved (kDevice).
  [[nodiscard]] static Result<UdpSocket> at(const UdpAddress& address);

  [[nodiscard]] int fd() const { return fd_; }
  /// Returns the local port; 0 if there is none.
  [[nodiscard]] int port() const;

 private:
  explicit UdpSocket(int fd) : fd_(fd) {}
  int fd_ = -1;
};

}  // namespace marey::live
