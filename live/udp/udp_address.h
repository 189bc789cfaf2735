// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "core/base/result.h"

namespace marey::live {

/// Where a UDP packet goes, or where packets are waited for.
struct UdpAddress {
  std::string host;
  int port = 0;
};

/// "host:port", "[::1]:port" of an IPv6 address; "host" alone has `default_port`.
/// Errors (kBadInput): no host; a port that is none of 1 to 65535.
[[nodiscard]] Result<UdpAddress> parse_udp_address(std::string_view text,
                                                   int default_port);

/// "host:port", brackets around what has colons.
[[nodiscard]] std::string text_of(const UdpAddress& address);

}  // namespace marey::live
