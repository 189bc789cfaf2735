// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace marey::live {

/// What happened to a WebServer since its start.
struct WebCounts {
  std::uint64_t requests = 0;        ///< Whose head was read, whatever the answer.
  std::uint64_t refused_host = 0;    ///< Asked for under a name that is not ours.
  std::uint64_t refused_origin = 0;  ///< Asked by another site's page.
  std::uint64_t refused_token = 0;
  std::uint64_t refused_request = 0;  ///< Malformed, too large, other than GET and HEAD.
  std::uint64_t refused_full = 0;     ///< Too many pages or connections.
  std::uint64_t pages_opened = 0;
  std::uint64_t pages_over_rate = 0;     ///< Closed, since they talked too much.
  std::uint64_t malformed_messages = 0;  ///< Too large, binary, or no WebSocket's.
  std::uint64_t dropped_texts = 0;  ///< Received, not taken in time, the oldest first.
  std::uint64_t sent_messages = 0;
};

}  // namespace marey::live
