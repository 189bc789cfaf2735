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

/// Access policy and source of the page.
struct PageServerOptions {
  int port = live::WebServerOptions::kDefaultPort;  ///< 0: any free port.
  bool lan = false;                ///< Other machines of the network too, with the token.
  bool open = true;                ///< In a browser, if there is a screen.
  std::filesystem::path web_root;  ///< Folder of the page; empty: built-in page.
};

/// A running server of the page, and its addresses.
struct PageServer {
  live::WebServer server;
  std::vector<std::string>
      addresses;  ///< "http://127.0.0.1:8790/", this machine's first.
};

/// Starts the server with the page. Errors: those of WebServer::start(); a file of the
/// web root cannot be read.
[[nodiscard]] Result<PageServer> start_page(const PageServerOptions& options);

/// Serves the files of a folder as the page, and updates the files that have changed.
class WebRoot {
 public:
  explicit WebRoot(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Serves the files that changed since the last call. Errors: a file cannot be read, or
  /// there is no index.html.
  [[nodiscard]] Status serve(live::WebServer& server);

 private:
  std::filesystem::path folder_;
  std::filesystem::file_time_type newest_ = std::filesystem::file_time_type::min();
};

/// Prints the addresses on standard output. Opens the first one in a browser if the
/// options request it and there is a screen. With `lan` it opens no browser, because all
/// users of this machine can read the arguments of a process, including the token.
void print_addresses(const PageServer& page, const PageServerOptions& options);

}  // namespace marey::app
