// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace marey::live {

/// Address, port, token and limits of a WebServer.
struct WebServerOptions {
  /// A numeric address of this machine. "0.0.0.0": all addresses; requires a token.
  std::string address = "127.0.0.1";
  int port = kDefaultPort;  ///< 0: any free port.
  /// Required for every request (live/web/access_token.h). Empty: no token is required.
  std::string token;
  std::size_t max_clients = 16;       ///< Open pages; further ones get status 503.
  std::size_t max_connections = 128;  ///< Pages and requests together.

  static constexpr int kDefaultPort = 8790;
};

}  // namespace marey::live
