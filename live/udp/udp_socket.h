// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "core/base/result.h"
#include "live/udp/udp_address.h"

namespace marey::live {

/// A UDP socket that never blocks, closed with its owner.
class UdpSocket {
 public:
  UdpSocket() = default;
  UdpSocket(UdpSocket&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  UdpSocket& operator=(UdpSocket&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~UdpSocket();

  /// A socket whose packets go to `address`, broadcasts included. Looks the name up,
  /// which may take seconds; of a host's addresses IPv4's come first. Errors: there is no
  /// such host (kBadInput); names cannot be looked up, or no network leads there
  /// (kDevice).
  [[nodiscard]] static Result<UdpSocket> to(const UdpAddress& address);

  /// A socket that hears packets for `address`: "127.0.0.1" hears this machine alone,
  /// "0.0.0.0" everybody. Port 0: any that is free.
  /// Errors: the host is no address of this machine (kBadInput); the port is taken or
  /// reserved (kDevice).
  [[nodiscard]] static Result<UdpSocket> at(const UdpAddress& address);

  [[nodiscard]] int fd() const { return fd_; }
  /// The port it has here; 0 when it has none.
  [[nodiscard]] int port() const;

 private:
  explicit UdpSocket(int fd) : fd_(fd) {}
  int fd_ = -1;
};

}  // namespace marey::live
