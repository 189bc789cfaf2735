// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/udp/udp_address.h"

#include <charconv>

namespace marey::live {
namespace {

Error unclear(std::string_view text, std::string cause) {
  return bad_input(std::string(text),
                   std::move(cause),
                   "write host:port, as in 127.0.0.1:39539 or [::1]:39539");
}

}  // namespace

Result<UdpAddress> parse_udp_address(std::string_view text, int default_port) {
  UdpAddress address{std::string(text), default_port};
  std::string_view port;
  const std::size_t colon = text.rfind(':');
  if (text.starts_with('[')) {
    const std::size_t end = text.find(']');
    if (end == std::string_view::npos) return unclear(text, "the bracket is not closed");
    address.host = text.substr(1, end - 1);
    port = text.substr(end + 1);
    if (!port.empty() && port.front() != ':') {
      return unclear(text, "only a port may follow the bracket");
    }
  } else if (colon != std::string_view::npos && text.find(':') == colon) {
    address.host = text.substr(0, colon);
    port = text.substr(colon);
  }
  if (address.host.empty()) return unclear(text, "there is no host");
  if (port.empty()) return address;
  port.remove_prefix(1);
  const auto [end, error] =
      std::from_chars(port.data(), port.data() + port.size(), address.port);
  const bool whole = error == std::errc() && end == port.data() + port.size();
  if (!whole || address.port < 1 || address.port > 65535) {
    return unclear(text, "the port is not a number from 1 to 65535");
  }
  return address;
}

std::string text_of(const UdpAddress& address) {
  const bool is_v6 = address.host.find(':') != std::string::npos;
  return (is_v6 ? "[" + address.host + "]" : address.host) + ":" +
         std::to_string(address.port);
}

}  // namespace marey::live
