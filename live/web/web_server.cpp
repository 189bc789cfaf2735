// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/web/web_server.h"

#include <cstdint>
#include <thread>
#include <utility>

#include <sys/eventfd.h>
#include <unistd.h>

#include "core/base/assert.h"
#include "live/web/web_loop.h"
#include "live/web/web_state.h"

namespace marey::live {

class WebServer::Running {
 public:
  explicit Running(WebServerOptions options)
      : options_(std::move(options)), wake_fd_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {}
  ~Running() {
    stop();
    ::close(wake_fd_);
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  Status start() {
    auto loop = WebLoop::listen(state, options_, wake_fd_);
    if (!loop) return loop.error();
    loop_ = *std::move(loop);
    port = loop_->port();
    thread_ = std::thread([this] { loop_->run(); });
    return Done{};
  }

  void stop() {
    if (!thread_.joinable()) return;
    state.inbox().close();
    loop_->end();
    thread_.join();
    loop_.reset();
  }

  /// Wakes the server's thread to send new messages.
  void ring() const {
    constexpr std::uint64_t kOnce = 1;
    // The write fails only if the eventfd is already signalled.
    [[maybe_unused]] const ssize_t written = write(wake_fd_, &kOnce, sizeof kOnce);
  }

  WebState state;
  int port = 0;

 private:
  const WebServerOptions options_;
  const int wake_fd_;
  std::unique_ptr<WebLoop> loop_;
  std::thread thread_;
};

namespace {

std::size_t slot_of(PageMessage kind) {
  switch (kind) {
    case PageMessage::kScene:
      return index(MessageSlot::kScene);
    case PageMessage::kStatus:
      return index(MessageSlot::kStatus);
    case PageMessage::kWizard:
      return index(MessageSlot::kWizard);
    case PageMessage::kConstraints:
      return index(MessageSlot::kConstraints);
    case PageMessage::kRun:
      return index(MessageSlot::kRun);
    case PageMessage::kTargets:
      return index(MessageSlot::kTargets);
    case PageMessage::kRevision:
      return index(MessageSlot::kRevision);
    case PageMessage::kProgress:
      return index(MessageSlot::kProgress);
    case PageMessage::kRendered:
      return index(MessageSlot::kRendered);
  }
  return index(MessageSlot::kStatus);
}

}  // namespace

Result<WebServer> WebServer::start(const WebServerOptions& options) {
  MAREY_ASSERT(options.port >= 0 && options.port <= 0xFFFF);
  auto running = std::make_unique<Running>(options);
  if (Status ok = running->start(); !ok) return ok.error();
  return WebServer(std::move(running));
}

WebServer::WebServer(std::unique_ptr<Running> running) : running_(std::move(running)) {}
WebServer::WebServer(WebServer&&) noexcept = default;
WebServer& WebServer::operator=(WebServer&&) noexcept = default;
WebServer::~WebServer() = default;

int WebServer::port() const {
  return running_->port;
}

void WebServer::put(WebContent content) {
  running_->state.put(std::move(content));
}

void WebServer::remove(std::string_view path) {
  running_->state.remove(path);
}

void WebServer::publish_text(PageMessage kind, std::string_view json) {
  running_->state.publish(slot_of(kind), json);
  running_->ring();
}

void WebServer::publish_frame(std::string_view bytes) {
  running_->state.publish(index(MessageSlot::kFrame), bytes);
  running_->ring();
}

void WebServer::publish_thumbnail(std::size_t camera, std::string_view bytes) {
  MAREY_ASSERT(camera < kMaxThumbnails);
  running_->state.publish(index(MessageSlot::kThumbnail) + camera, bytes);
  running_->ring();
}

void WebServer::answer_text(ClientId client, std::string_view json) {
  running_->state.answer(client, false, json);
  running_->ring();
}

void WebServer::answer_frame(ClientId client, std::string_view bytes) {
  running_->state.answer(client, true, bytes);
  running_->ring();
}

void WebServer::queue_text(ClientId client, std::string_view json) {
  running_->state.queue(client, json);
  running_->ring();
}

void WebServer::take_texts(std::vector<ReceivedText>& out) {
  running_->state.inbox().take(out);
}

bool WebServer::wait_for_text(std::chrono::milliseconds longest) {
  return running_->state.inbox().wait(longest);
}

std::size_t WebServer::client_count() const {
  return running_->state.page_count();
}

WebCounts WebServer::counts() const {
  return running_->state.counts();
}

void WebServer::stop() {
  running_->stop();
}

}  // namespace marey::live
