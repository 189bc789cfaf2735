// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace marey::live {

/// Fields of a request's head, unchanged; empty: the field is absent.
struct RequestHead {
  std::string_view method{};
  std::string_view target{};  ///< Such as "/page.js?token=5f".
  std::string_view host{};
  std::string_view origin{};
  std::string_view cookie{};
};

/// Conditions for access.
struct AccessPolicy {
  std::string address{};  ///< Local address of the connection: "127.0.0.1", "::1".
  bool loopback = false;
  int port = 0;
  std::string_view token{};  ///< Empty: no token is required.
};

enum class Verdict {
  kAccepted,
  kWrongMethod,  ///< Other than GET and HEAD.
  kWrongTarget,  ///< The target does not begin with "/".
  kWrongHost,    ///< Another host name: a foreign page may use DNS rebinding.
  kWrongOrigin,  ///< Requested by the page of another site.
  kWrongToken,
};

/// The verdict on a request, and its path.
struct RequestVerdict {
  Verdict verdict = Verdict::kWrongTarget;
  std::string_view path{};      ///< Without the query; a view into the head's target.
  bool token_in_query = false;  ///< The query has the right token: set the cookie.
};
/// Determines whether a request has access, and finds its path.
///
/// Host must be the local address and port of the connection, or "localhost" if that
/// address is the loopback. Other names are refused, because the owner of a name can
/// point it at this machine. Origin, which browsers send with every request of a foreign
/// page and with WebSockets, must be "http://" followed by Host. The token is the query's
/// "token" or the cookie "marey_token". Never allocates.
[[nodiscard]] RequestVerdict authorize_request(const RequestHead& head,
                                               const AccessPolicy& policy);

/// Returns the value of a cookie in a Cookie header, or of a parameter in a query; empty
/// if there is none. Nothing is decoded.
[[nodiscard]] std::string_view cookie_value(std::string_view cookies,
                                            std::string_view name);
[[nodiscard]] std::string_view query_value(std::string_view query, std::string_view name);

/// Returns true if an If-None-Match header contains this ETag or "*".
[[nodiscard]] bool has_etag(std::string_view if_none_match, std::string_view etag);

}  // namespace marey::live
