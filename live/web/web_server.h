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

/// Kind of a text message to the pages. Only the newest of each kind is sent.
enum class PageMessage {
  kScene,
  kStatus,
  kWizard,
  kConstraints,
  kRun,      ///< State and figures of a scene that runs live.
  kTargets,  ///< Places of its targets.
  // Messages of the page of marey edit.
  kRevision,
  kProgress,
  kRendered,
};

/// Serves the page and exchanges messages with it: docs/formats/page.md. The server has
/// its own thread; every function here may be called from any thread.
///
/// A new page receives the scene first, then the newest message of every other kind. A
/// published message replaces an unsent one of its kind. A slow browser therefore misses
/// messages and delays no other, and memory is bounded (the newest message of each kind,
/// and one message being sent per page). Publishing copies the message into a reused
/// buffer, does not wait for the network, and allocates nothing once buffers have grown.
/// It takes about ten microseconds, mostly to wake the server's thread, plus at most the
/// time in which that thread copies one message.
class WebServer {
 public:
  /// Binds and starts to listen.
  /// Errors: kDevice if the port is in use or not permitted, or if the address is not
  /// this machine's; kBadInput if the text is not an address, or if other machines can
  /// reach it and there is no token.
  [[nodiscard]] static Result<WebServer> start(const WebServerOptions& options);

  WebServer(WebServer&&) noexcept;
  WebServer& operator=(WebServer&&) noexcept;
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;
  /// Calls stop().
  ~WebServer();

  /// Returns the bound port.
  [[nodiscard]] int port() const;

  /// Adds content, or replaces the content with the same path. Precondition:
  /// is_web_path(path), bytes not null.
  void put(WebContent content);

  /// Removes content. Answers that are being sent are completed. No effect if there is
  /// none at this path.
  void remove(std::string_view path);

  /// Sends a text to every page. A new scene removes unsent frames and thumbnails,
  /// because they belong to the old one.
  void publish_text(PageMessage kind, std::string_view json);
  /// Sends one frame (live/page/page_frame.h) to every page.
  void publish_frame(std::string_view bytes);
  /// Sends a camera's picture to every page. Precondition: camera < 64.
  void publish_thumbnail(std::size_t camera, std::string_view bytes);
  /// Sends a text or a frame to one page, if it is still connected. Only the newest
  /// unsent text and the newest unsent frame are kept.
  void answer_text(ClientId client, std::string_view json);
  void answer_frame(ClientId client, std::string_view bytes);
  /// Sends a text to one page, if it is still connected, after those queued before. At
  /// most WebState::kMaxQueued unsent ones are kept; beyond that the oldest are dropped.
  void queue_text(ClientId client, std::string_view json);

  /// Moves the texts received since the last call to `out`, oldest first; `out` is
  /// emptied before. At most 256 texts of 16 kB are kept; beyond that the oldest are
  /// dropped.
  void take_texts(std::vector<ReceivedText>& out);
  /// Blocks until there is a text or `longest` has passed; returns true if there is one.
  bool wait_for_text(std::chrono::milliseconds longest);

  [[nodiscard]] std::size_t client_count() const;
  [[nodiscard]] WebCounts counts() const;

  /// Closes every connection and ends the thread. Nothing is sent or received after that.
  void stop();

 private:
  class Running;
  explicit WebServer(std::unique_ptr<Running> running);

  std::unique_ptr<Running> running_;
};

}  // namespace marey::live
