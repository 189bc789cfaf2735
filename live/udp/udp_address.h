// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "core/base/result.h"

namespace marey::live {

/// Destination of UDP packets, or the address at which they are received.
struct UdpAddress {
  std::string host;
  int port = 0;
};

/// Parses "host:port", "[::1]:port" for an IPv6 address, or "host", which gets
/// `default_port`. Errors (kBadInput): no host; a port that is not in 1 to 65535.
[[nodiscard]] Result<UdpAddress> parse_udp_address(std::string_view text,
                                                   int default_port);

/// Returns "host:port". A host with colons is put in brackets.
[[nodiscard]] std::string text_of(const UdpAddress& address);

}  // namespace marey::live
