// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/udp/udp_listener.h"

#include <algorithm>

#include <poll.h>
#include <sys/socket.h>

namespace marey::live {
namespace {

constexpr std::size_t kMaxReceivedBytes = 65535;
// Holds a few hundred frames that arrive while the program is busy. The kernel may grant
// less; frames that do not fit are then lost, which is acceptable.
constexpr int kBufferBytes = 1 << 20;

}  // namespace

UdpListener::UdpListener(UdpSocket socket)
    : socket_(std::move(socket)), buffer_(kMaxReceivedBytes) {}

Result<UdpListener> UdpListener::open(const UdpAddress& address) {
  Result<UdpSocket> socket = UdpSocket::at(address);
  if (!socket) return socket.error();
  setsockopt(socket->fd(), SOL_SOCKET, SO_RCVBUF, &kBufferBytes, sizeof kBufferBytes);
  return UdpListener(*std::move(socket));
}

std::optional<std::span<const std::uint8_t>> UdpListener::receive() {
  const ssize_t size = recv(socket_.fd(), buffer_.data(), buffer_.size(), MSG_DONTWAIT);
  if (size < 0) return std::nullopt;
  return std::span(buffer_).first(static_cast<std::size_t>(size));
}

void UdpListener::wait(std::chrono::milliseconds longest) const {
  pollfd waiting{socket_.fd(), POLLIN, 0};
  poll(&waiting, 1, static_cast<int>(std::max<std::int64_t>(longest.count(), 0)));
}

}  // namespace marey::live
