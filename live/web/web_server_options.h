// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace marey::live {

/// Address, port, token and limits of a WebServer.
struct WebServerOptions {
  /// An address of this machine, as digits. "0.0.0.0": every one, which wants a token.
  std::string address = "127.0.0.1";
  int port = kDefaultPort;  ///< 0: any that is free.
  /// Who does not know it gets nothing (live/web/access_token.h). Empty: everybody who
  /// can reach the address does.
  std::string token;
  std::size_t max_clients = 16;       ///< Pages at a time; who comes later is told so.
  std::size_t max_connections = 128;  ///< Pages and fetches together.

  static constexpr int kDefaultPort = 8790;
};

}  // namespace marey::live
