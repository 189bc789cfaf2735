// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "live/web/request_check.h"
#include "live/web/web_state.h"

namespace marey::live {

/// The answer to one request, ready for the socket.
struct HttpAnswer {
  std::string head;  ///< Status line and headers, the empty line included.
  std::shared_ptr<const std::string> body;  ///< nullptr: none.
};

/// How a request that is not served is answered.
enum class RejectReason {
  kMalformed,   ///< 400
  kHeadTooBig,  ///< 431
  kFull,        ///< 503
  kNoUpgrade,   ///< 426: the WebSocket's path, fetched.
};

/// Answers a request that was checked: content, 304 for who has it already, or why not.
/// Counts what is refused. `keep_alive`: the connection stays open.
[[nodiscard]] HttpAnswer answer_request(const CheckedRequest& request,
                                        const RequestHead& head,
                                        std::string_view if_none_match,
                                        std::string_view token,
                                        bool keep_alive,
                                        WebState& state);

/// Likewise, and closes the connection.
[[nodiscard]] HttpAnswer reject_request(RejectReason why, WebState& state);

}  // namespace marey::live
