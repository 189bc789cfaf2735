// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "core/result.h"
#include "live/web_server.h"
#include "live/web_state.h"

namespace marey::live {

/// The sockets of a WebServer. Behind a wall, since Boost.Beast takes long to compile.
class WebLoop {
 public:
  /// Binds and listens. `bell`: an eventfd that says that the state has something new to
  /// send; all three outlive the loop.
  /// Errors: WebServer::start()'s. Precondition: 0 <= port <= 65535.
  [[nodiscard]] static Result<std::unique_ptr<WebLoop>> listen(
      WebState& state, const WebServerOptions& options, int bell);

  WebLoop() = default;
  virtual ~WebLoop() = default;
  WebLoop(const WebLoop&) = delete;
  WebLoop& operator=(const WebLoop&) = delete;

  [[nodiscard]] virtual int port() const = 0;
  /// Serves until end(), which may be called from any thread.
  virtual void run() = 0;
  virtual void end() = 0;
};

}  // namespace marey::live
