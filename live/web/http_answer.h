// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "live/web/authorize_request.h"
#include "live/web/web_state.h"

namespace marey::live {

/// The response to one request, ready for the socket.
struct HttpAnswer {
  std::string head;  ///< Status line and headers, with the empty line at the end.
  std::shared_ptr<const std::string> body;  ///< nullptr: none.
};

/// Reason why a request is not served, with its HTTP status.
enum class RejectReason {
  kMalformed,   ///< 400
  kHeadTooBig,  ///< 431
  kFull,        ///< 503
  kNoUpgrade,   ///< 426: a plain request for the WebSocket's path.
};

/// Answers a checked request with the content, with 304 if the browser already has it, or
/// with an error status. Counts refused requests. `keep_alive`: the connection stays
/// open.
[[nodiscard]] HttpAnswer answer_request(const RequestVerdict& request,
                                        const RequestHead& head,
                                        std::string_view if_none_match,
                                        std::string_view token,
                                        bool keep_alive,
                                        WebState& state);

/// Returns the response to a request that is not served. The response closes the
/// connection.
[[nodiscard]] HttpAnswer reject_request(RejectReason why, WebState& state);

}  // namespace marey::live
