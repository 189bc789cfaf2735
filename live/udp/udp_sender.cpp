// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/udp/udp_sender.h"

#include <cerrno>

#include <sys/socket.h>

namespace marey::live {
namespace {

bool sent(const UdpSocket& socket, std::span<const std::uint8_t> packet) {
  return ::send(socket.fd(), packet.data(), packet.size(), MSG_NOSIGNAL | MSG_DONTWAIT) >=
         0;
}

}  // namespace

Result<UdpSender> UdpSender::open(std::span<const UdpAddress> addresses) {
  UdpSender sender;
  for (const UdpAddress& address : addresses) {
    Result<UdpSocket> socket = UdpSocket::to(address);
    if (!socket) return socket.error();
    sender.sockets_.push_back(*std::move(socket));
  }
  sender.counts_.resize(addresses.size());
  return sender;
}

void UdpSender::send(std::span<const std::uint8_t> packet) {
  for (std::size_t i = 0; i < sockets_.size(); ++i) {
    UdpCounts& counts = counts_[i];
    bool ok = sent(sockets_[i], packet);
    if (!ok && errno == ECONNREFUSED) {
      // The error reports an earlier packet; this packet was not sent.
      ++counts.refused;
      ok = sent(sockets_[i], packet);
    }
    ++(ok ? counts.sent : counts.failed);
  }
}

}  // namespace marey::live
