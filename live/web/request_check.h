// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace marey::live {

/// What a request says of itself, as it stands in its head; empty: it does not say.
struct RequestHead {
  std::string_view method{};
  std::string_view target{};  ///< "/page.js?token=5f".
  std::string_view host{};
  std::string_view origin{};
  std::string_view cookie{};
};

/// Who may ask.
struct AccessPolicy {
  std::string address{};  ///< Of this end of the connection: "127.0.0.1", "::1".
  bool loopback = false;
  int port = 0;
  std::string_view token{};  ///< Empty: nobody needs one.
};

enum class Verdict {
  kAccepted,
  kWrongMethod,  ///< Other than GET and HEAD.
  kWrongTarget,  ///< Not a path of ours.
  kWrongHost,    ///< Asked for under another name: a foreign page that renamed us.
  kWrongOrigin,  ///< Asked by another site's page.
  kWrongToken,
};

/// Decides on one request, and finds its path in it.
///
/// Host has to be the address and port of this end of the connection, or "localhost" when
/// that end is the loopback; no other name, since a name can be pointed at us by whoever
/// owns it. Origin, which browsers send with every request of a foreign page and with
/// WebSockets, has to be http:// and that Host. The token is the query's "token" or the
/// cookie "marey_token". Never allocates.
struct CheckedRequest {
  Verdict verdict = Verdict::kWrongTarget;
  std::string_view path{};      ///< Without its query; part of the head's target.
  bool token_in_query = false;  ///< And right: a cookie is to be set.
};
[[nodiscard]] CheckedRequest check_request(const RequestHead& head,
                                           const AccessPolicy& policy);

/// The value of a cookie in a Cookie header, or of a parameter in a query; empty: it has
/// none. Names are as they stand, nothing is decoded.
[[nodiscard]] std::string_view cookie_value(std::string_view cookies,
                                            std::string_view name);
[[nodiscard]] std::string_view query_value(std::string_view query, std::string_view name);

/// Whether an If-None-Match header names this ETag, or any.
[[nodiscard]] bool has_etag(std::string_view if_none_match, std::string_view etag);

}  // namespace marey::live
