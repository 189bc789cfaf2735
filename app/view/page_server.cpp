// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/view/page_server.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <utility>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/view/view_page.h"
#include "core/base/extension.h"
#include "live/web/access_token.h"
#include "live/web/local_addresses.h"
#include "live/web/page_embedded.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

const std::map<std::string, std::string> kTypes = {
    {".html", "text/html; charset=utf-8"},
    {".js", "text/javascript; charset=utf-8"},
    {".css", "text/css; charset=utf-8"},
    {".svg", "image/svg+xml"},
};

/// All users of this machine can see `address` in the list of processes.
void open_in_browser(const std::string& address) {
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) {
    return;
  }
  std::string program = "/bin/sh";
  std::string option = "-c";
  // The shell ends at once, so that marey does not wait for the browser.
  std::string script = "xdg-open \"$0\" &";
  std::string argument = address;
  const std::array<char*, 5> arguments{
      program.data(), option.data(), script.data(), argument.data(), nullptr};
  pid_t child = 0;
  // If the browser fails, the address was already printed.
  if (posix_spawn(&child, program.c_str(), nullptr, nullptr, arguments.data(), environ) ==
      0) {
    while (waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
}

}  // namespace

Status WebRoot::serve(live::WebServer& server) {
  std::error_code failed;
  fs::file_time_type newest = newest_;
  bool has_index = false;
  for (const auto& entry : fs::directory_iterator(folder_, failed)) {
    const auto type = kTypes.find(kind_by_extension(entry.path()));
    if (type == kTypes.end()) continue;
    const std::string name = entry.path().filename().string();
    const bool is_index = name == "index.html";
    std::string path = "/";
    if (!is_index) path.append(name);
    has_index |= is_index;
    std::error_code unknown;
    const auto changed = entry.last_write_time(unknown);
    newest = std::max(newest, changed);
    if (changed <= newest_ || !live::is_web_path(path)) continue;
    auto content = file_content(entry.path(), path, type->second);
    if (!content) return content.error();
    server.put(*std::move(content));
  }
  if (!has_index) {
    return bad_input(folder_.string(),
                     "holds no index.html",
                     "build the page there: npm run build in live/viewer");
  }
  newest_ = newest;
  return Done{};
}

Result<PageServer> start_page(const PageServerOptions& options) {
  live::WebServerOptions served;
  served.port = options.port;
  if (options.lan) {
    auto token = live::make_access_token();
    if (!token) return token.error();
    served.address = "0.0.0.0";
    served.token = *std::move(token);
  }
  auto server = live::WebServer::start(served);
  if (!server) return server.error();
  if (options.web_root.empty()) {
    for (live::WebContent& content : live::embedded_page()) {
      server->put(std::move(content));
    }
  } else if (Status ok = WebRoot(options.web_root).serve(*server); !ok) {
    return ok.error();
  }
  std::string after = ":";
  after += std::to_string(server->port());
  after += '/';
  if (options.lan) after += "?token=" + served.token;
  PageServer page{*std::move(server), {std::string("http://127.0.0.1").append(after)}};
  if (options.lan) {
    for (const std::string& address : live::local_addresses()) {
      page.addresses.push_back(std::string("http://").append(address).append(after));
    }
  }
  return page;
}

void print_addresses(const PageServer& page, const PageServerOptions& options) {
  for (const std::string& address : page.addresses) std::printf("%s\n", address.c_str());
  std::fflush(stdout);
  // An address with a token must not appear in the list of processes.
  if (!options.open || options.lan || isatty(STDOUT_FILENO) == 0) return;
  open_in_browser(page.addresses.front());
}

}  // namespace marey::app
