// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace marey::live {

/// Counts of a WebServer since its start.
struct WebCounts {
  std::uint64_t requests = 0;        ///< Requests with a complete head, refused ones too.
  std::uint64_t refused_host = 0;    ///< Requests with another host name.
  std::uint64_t refused_origin = 0;  ///< Requests by the page of another site.
  std::uint64_t refused_token = 0;
  std::uint64_t refused_request = 0;  ///< Malformed, too large, other than GET and HEAD.
  std::uint64_t refused_full = 0;     ///< Too many pages or connections.
  std::uint64_t pages_opened = 0;
  std::uint64_t pages_over_rate = 0;     ///< Closed: they sent too many messages.
  std::uint64_t malformed_messages = 0;  ///< Too large, binary, or not WebSocket data.
  std::uint64_t dropped_texts = 0;       ///< Received texts that were not taken in time.
  std::uint64_t sent_messages = 0;
};

}  // namespace marey::live
