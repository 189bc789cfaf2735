// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/shell/console.h"
#include "core/base/result.h"
#include "live/web/web_server.h"

namespace marey::app {

/// Who may look at the page, and where it comes from.
struct PageServerOptions {
  int port = live::WebServerOptions::kDefaultPort;  ///< 0: any that is free.
  bool lan = false;                ///< Others on the network too, who know the token.
  bool open = true;                ///< In a browser, where there is a screen.
  std::filesystem::path web_root;  ///< Serve this folder's page; empty: the built-in.
};

/// A running page and the addresses by which it is reached.
struct PageServer {
  live::WebServer server;
  std::vector<std::string>
      addresses;  ///< "http://127.0.0.1:8790/", this machine's first.
};

/// Starts the server with the page in it. Errors: WebServer::start()'s; the web root's
/// files cannot be read.
[[nodiscard]] Result<PageServer> start_page(const PageServerOptions& options);

/// Serves the files of a folder as the page, and again what changed since the last call.
class WebRoot {
 public:
  explicit WebRoot(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Errors: a file cannot be read, or there is no index.html.
  [[nodiscard]] Status serve(live::WebServer& server);

 private:
  std::filesystem::path folder_;
  std::filesystem::file_time_type newest_ = std::filesystem::file_time_type::min();
};

/// Prints the addresses on standard output, and opens the first in a browser if that is
/// wanted and there is a screen; with `lan` it opens none, since everybody on this machine
/// can read with what a program was started, the token too.
void print_addresses(const PageServer& page, const PageServerOptions& options);

}  // namespace marey::app
