// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "live/web/received_text.h"
#include "live/web/web_content.h"
#include "live/web/web_counts.h"
#include "live/web/web_server_options.h"

namespace marey::live {

/// What a message to the pages is about. Of each kind a page is only ever sent the
/// newest.
enum class PageMessage { kScene, kStatus, kWizard, kConstraints };

/// Serves the page and speaks with it: docs/formats/page.md. A thread of its own
/// does all of it; every function here may be called from any thread.
///
/// A new page is sent the scene first, then the newest of everything else. What is
/// published replaces what was published before and not yet sent: a browser that does not
/// keep up misses messages and delays nobody, and memory stays bounded (the newest of
/// each kind, and one message under way for each page). Publishing copies the message
/// into a buffer that is kept, waits for no network and allocates nothing once buffers
/// have grown: some ten microseconds, most of them to wake the server's thread, and at
/// most as long as that takes to copy one message besides.
class WebServer {
 public:
  /// Binds and starts to listen.
  /// Errors: kDevice when the port is in use, may not be used or the address is not this
  /// machine's; kBadInput when the address is none, or others could reach it and there is
  /// no token.
  [[nodiscard]] static Result<WebServer> start(const WebServerOptions& options);

  WebServer(WebServer&&) noexcept;
  WebServer& operator=(WebServer&&) noexcept;
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;
  /// stop().
  ~WebServer();

  /// The port that was bound.
  [[nodiscard]] int port() const;

  /// Adds content, or replaces what had its path. Precondition: is_web_path(path), bytes
  /// not null.
  void put(WebContent content);

  /// Sends a text to every page. A new scene makes what was published of frames and
  /// thumbnails void: they were of the old one.
  void publish_text(PageMessage kind, std::string_view json);
  /// One frame (live/page/page_frame.h), to every page.
  void publish_frame(std::string_view bytes);
  /// A camera's picture, to every page. Precondition: camera < 64.
  void publish_thumbnail(std::size_t camera, std::string_view bytes);
  /// To one page alone, if it is still there: of answers too only the newest counts, of
  /// texts and of frames each.
  void answer_text(ClientId client, std::string_view json);
  void answer_frame(ClientId client, std::string_view bytes);

  /// What pages said since the last call, oldest first; `out` is emptied before. At most
  /// 256 texts of 16 kB wait here, then the oldest are dropped.
  void take_texts(std::vector<ReceivedText>& out);
  /// Until a text is there or the time is over; whether one is.
  bool wait_for_text(std::chrono::milliseconds longest);

  [[nodiscard]] std::size_t client_count() const;
  [[nodiscard]] WebCounts counts() const;

  /// Closes every connection and ends the thread. Nothing is sent or received any more.
  void stop();

 private:
  class Running;
  explicit WebServer(std::unique_ptr<Running> running);

  std::unique_ptr<Running> running_;
};

}  // namespace marey::live
