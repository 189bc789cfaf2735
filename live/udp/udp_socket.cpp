// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/udp/udp_socket.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <system_error>
#include <vector>

#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace marey::live {
namespace {

using AddressList = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

Error trouble(const UdpAddress& address, int problem, std::string next) {
  return {Errc::kDevice,
          text_of(address),
          std::generic_category().message(problem),
          std::move(next)};
}

/// Returns every address of the host, or an error.
Result<AddressList> look_up(const UdpAddress& address) {
  addrinfo wanted{};
  wanted.ai_family = AF_UNSPEC;
  wanted.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const int problem = getaddrinfo(
      address.host.c_str(), std::to_string(address.port).c_str(), &wanted, &found);
  if (problem == 0) return AddressList(found, &freeaddrinfo);
  if (problem == EAI_NONAME) {
    return bad_input(text_of(address),
                     "there is no host with this name",
                     "check its spelling, or give its address");
  }
  return Error{Errc::kDevice,
               text_of(address),
               std::string("the name cannot be looked up: ") + gai_strerror(problem),
               "check the network, or give the host's address"};
}

/// Orders IPv4 before IPv6. UDP has no acknowledgement, so only the first address is ever
/// tried. VMC receivers at "localhost" mostly listen at 127.0.0.1 only, not at ::1.
std::vector<const addrinfo*> old_network_first(const addrinfo& list) {
  std::vector<const addrinfo*> order;
  for (const addrinfo* at = &list; at != nullptr; at = at->ai_next) order.push_back(at);
  std::stable_partition(order.begin(), order.end(), [](const addrinfo* at) {
    return at->ai_family == AF_INET;
  });
  return order;
}

int open_socket(const addrinfo& address) {
  return socket(address.ai_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
}

}  // namespace

UdpSocket::~UdpSocket() {
  if (fd_ >= 0) close(fd_);
}

Result<UdpSocket> UdpSocket::to(const UdpAddress& address) {
  const Result<AddressList> list = look_up(address);
  if (!list) return list.error();
  int problem = 0;
  for (const addrinfo* at : old_network_first(**list)) {
    UdpSocket made(open_socket(*at));
    const int on = 1;
    // The socket is connected, so a missing receiver is reported as ECONNREFUSED.
    if (made.fd_ >= 0 &&
        setsockopt(made.fd_, SOL_SOCKET, SO_BROADCAST, &on, sizeof on) == 0 &&
        connect(made.fd_, at->ai_addr, at->ai_addrlen) == 0) {
      return made;
    }
    problem = errno;
  }
  return trouble(address, problem, "check the network and the address");
}

Result<UdpSocket> UdpSocket::at(const UdpAddress& address) {
  const Result<AddressList> list = look_up(address);
  if (!list) return list.error();
  int problem = 0;
  for (const addrinfo* at : old_network_first(**list)) {
    UdpSocket made(open_socket(*at));
    if (made.fd_ >= 0 && bind(made.fd_, at->ai_addr, at->ai_addrlen) == 0) return made;
    problem = errno;
  }
  if (problem == EADDRINUSE) {
    return Error{Errc::kDevice,
                 text_of(address),
                 "another program uses this UDP port",
                 "end it, or choose another port"};
  }
  if (problem == EADDRNOTAVAIL) {
    return bad_input(text_of(address),
                     "this machine has no such address",
                     "listen at 127.0.0.1 (this machine only) or 0.0.0.0 (all machines)");
  }
  return trouble(address, problem, "choose another port, above 1023");
}

int UdpSocket::port() const {
  sockaddr_storage own{};
  socklen_t size = sizeof own;
  if (getsockname(fd_, reinterpret_cast<sockaddr*>(&own), &size) != 0) return 0;
  if (own.ss_family == AF_INET6) {
    sockaddr_in6 v6{};
    std::memcpy(&v6, &own, sizeof v6);
    return ntohs(v6.sin6_port);
  }
  sockaddr_in v4{};
  std::memcpy(&v4, &own, sizeof v4);
  return ntohs(v4.sin_port);
}

}  // namespace marey::live
