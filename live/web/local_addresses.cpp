// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/web/local_addresses.h"

#include <array>
#include <memory>

#include <ifaddrs.h>
#include <net/if.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

namespace marey::live {

std::vector<std::string> local_addresses() {
  std::vector<std::string> out;
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return out;
  const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> owner(list, freeifaddrs);
  for (const ifaddrs* one = list; one != nullptr; one = one->ifa_next) {
    if (one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET) continue;
    if ((one->ifa_flags & IFF_LOOPBACK) != 0U || (one->ifa_flags & IFF_UP) == 0U)
      continue;
    std::array<char, NI_MAXHOST> text{};
    const int failed = getnameinfo(one->ifa_addr,
                                   sizeof(sockaddr_in),
                                   text.data(),
                                   text.size(),
                                   nullptr,
                                   0,
                                   NI_NUMERICHOST);
    if (failed == 0) out.emplace_back(text.data());
  }
  return out;
}

}  // namespace marey::live
