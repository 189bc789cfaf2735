// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "core/base/result.h"
#include "live/web/web_server_options.h"
#include "live/web/web_state.h"

namespace marey::live {

/// The sockets of a WebServer. An interface, because Boost.Beast takes long to compile.
class WebLoop {
 public:
  /// Binds and listens. `wake_fd`: an eventfd that is signalled when the state has
  /// new messages. All three must outlive the loop. Errors: those of
  /// WebServer::start(). Precondition: 0 <= port <= 65535.
  [[nodiscard]] static Result<std::unique_ptr<WebLoop>> listen(
      WebState& state, const WebServerOptions& options, int wake_fd);

  WebLoop() = default;
  virtual ~WebLoop() = default;
  WebLoop(const WebLoop&) = delete;
  WebLoop& operator=(const WebLoop&) = delete;

  [[nodiscard]] virtual int port() const = 0;
  /// Serves until end() is called, which any thread may do.
  virtual void run() = 0;
  virtual void end() = 0;
};

}  // namespace marey::live
