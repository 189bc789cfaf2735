// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/web/web_loop.h"

#include <array>
#include <exception>
#include <optional>
#include <utility>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <unistd.h>

#include "live/web/authorize_request.h"
#include "live/web/http_answer.h"
#include "live/web/page_session.h"
#include "live/web/web_state.h"

namespace marey::live {
namespace {

using asio::ip::tcp;
using std::chrono::seconds;

constexpr unsigned kMaxHeadBytes = 8 * 1024;
constexpr std::string_view kSocketPath = "/live";
/// Time limit for a complete head to arrive, as a protection against slow clients.
constexpr seconds kReadTime{10};
/// Time limit for a complete response to be sent: 20 MB over a slow wireless network.
constexpr seconds kWriteTime{120};

std::string_view view(beast::string_view text) {
  return {text.data(), text.size()};
}

/// One connection that serves requests one after the other, and may become a PageSession.
/// Its pending handlers own it.
class FetchSession : public std::enable_shared_from_this<FetchSession> {
 public:
  FetchSession(tcp::socket socket, const AccessPolicy& policy, ServerState& server)
      : connection_(std::make_unique<CountedConnection>(server)),
        server_(server),
        policy_(policy),
        stream_(std::move(socket)) {}

  void read() {
    parser_.emplace();
    parser_->header_limit(kMaxHeadBytes);
    stream_.expires_after(kReadTime);
    http::async_read_header(stream_,
                            incoming_,
                            *parser_,
                            [self = shared_from_this()](error_code failed, std::size_t) {
                              if (failed) {
                                self->on_unreadable(failed);
                              } else {
                                self->on_request();
                              }
                            });
  }

 private:
  void on_unreadable(error_code failed) {
    // The client closed the connection or was too slow.
    if (failed == http::error::end_of_stream || failed == http::error::partial_message ||
        failed.category() != http::make_error_code(http::error::end_of_stream).category())
      return;
    server_.state.count(&WebCounts::requests);
    const bool too_big = failed == http::error::header_limit;
    send(reject_request(too_big ? RejectReason::kHeadTooBig : RejectReason::kMalformed,
                        server_.state),
         false);
  }

  [[nodiscard]] std::string_view field(http::field name) const {
    const auto& request = parser_->get();
    // A repeated header is ambiguous (request smuggling): it counts as absent.
    return request.count(name) == 1 ? view(request[name]) : std::string_view();
  }

  void on_request() {
    server_.state.count(&WebCounts::requests);
    const auto& request = parser_->get();
    const RequestHead head{.method = view(request.method_string()),
                           .target = view(request.target()),
                           .host = field(http::field::host),
                           .origin = field(http::field::origin),
                           .cookie = field(http::field::cookie)};
    if (request.count(http::field::origin) > 1) {
      return send(reject_request(RejectReason::kMalformed, server_.state), false);
    }
    const RequestVerdict checked = authorize_request(head, policy_);
    if (checked.verdict == Verdict::kAccepted) {
      if (!parser_->is_done()) {  // The request has a body.
        return send(reject_request(RejectReason::kMalformed, server_.state), false);
      }
      if (checked.path == kSocketPath) return open_page();
    }
    const bool keep = checked.verdict == Verdict::kAccepted && parser_->keep_alive();
    send(answer_request(checked,
                        head,
                        field(http::field::if_none_match),
                        policy_.token,
                        keep,
                        server_.state),
         keep);
  }

  void open_page() {
    if (!websocket::is_upgrade(parser_->get())) {
      return send(reject_request(RejectReason::kNoUpgrade, server_.state), false);
    }
    if (server_.pages.size() >= server_.options.max_clients) {
      return send(reject_request(RejectReason::kFull, server_.state), false);
    }
    std::make_shared<PageSession>(std::move(stream_), std::move(connection_))
        ->start(parser_->get());
  }

  void send(HttpAnswer answer, bool keep_alive) {
    answer_ = std::move(answer);
    const std::array<asio::const_buffer, 2> parts{
        asio::buffer(answer_.head),
        answer_.body ? asio::buffer(*answer_.body) : asio::const_buffer()};
    stream_.expires_after(kWriteTime);
    asio::async_write(
        stream_,
        parts,
        [self = shared_from_this(), keep_alive](error_code failed, std::size_t) {
          self->answer_ = {};
          if (failed) return;
          if (keep_alive) {
            self->read();
          } else {
            self->leave();
          }
        });
  }

  /// Closes after the client has read the response: closing with unread bytes resets the
  /// connection, which may discard the response.
  void leave() {
    error_code ignored;
    stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    stream_.expires_after(seconds(1));
    drain();
  }
  void drain() {
    stream_.async_read_some(
        asio::buffer(drained_),
        [self = shared_from_this()](error_code failed, std::size_t size) {
          constexpr std::size_t kEnough = 64 * 1024;
          self->drained_bytes_ += size;
          if (!failed && self->drained_bytes_ < kEnough) self->drain();
        });
  }

  std::unique_ptr<CountedConnection> connection_;
  ServerState& server_;
  AccessPolicy policy_;
  beast::tcp_stream stream_;
  beast::flat_buffer incoming_{kMaxHeadBytes};
  std::optional<http::request_parser<http::empty_body>> parser_;
  HttpAnswer answer_;
  std::array<char, 1024> drained_{};
  std::size_t drained_bytes_ = 0;
};

/// The acceptor, and the eventfd through which other threads wake the loop.
class Sockets final : public WebLoop {
 public:
  Sockets(WebState& state, const WebServerOptions& options, int wake_fd)
      : server_{state, options}, wake_(io_, dup(wake_fd)) {}

  error_code listen(const tcp::endpoint& endpoint) {
    error_code failed;
    acceptor_.open(endpoint.protocol(), failed);
    if (!failed) acceptor_.set_option(tcp::acceptor::reuse_address(true), failed);
    if (!failed) acceptor_.bind(endpoint, failed);
    if (!failed) acceptor_.listen(asio::socket_base::max_listen_connections, failed);
    if (!failed) server_.port = acceptor_.local_endpoint(failed).port();
    return failed;
  }

  [[nodiscard]] int port() const override { return server_.port; }

  void run() override {
    while (!io_.stopped()) {
      try {
        // Restart the waits that an exception interrupted.
        if (!accepts_) accept();
        if (!awaits_wake_) wait_for_wake();
        io_.run();
      } catch (const std::exception&) {
        // The failure of one connection, such as lack of memory, must not end the others.
      }
    }
  }
  void end() override { io_.stop(); }

 private:
  // Handlers start the next wait before they do anything that may throw.
  void accept() {
    acceptor_.async_accept([this](error_code failed, tcp::socket socket) {
      accepts_ = false;
      if (failed) return accept_later();
      accept();
      open_connection(std::move(socket));
    });
    accepts_ = true;
  }

  /// Accepts again after a pause. The likely cause: no file descriptors are left.
  void accept_later() {
    pause_.expires_after(std::chrono::milliseconds(100));
    pause_.async_wait([this](error_code) {
      accepts_ = false;
      accept();
    });
    accepts_ = true;
  }

  void open_connection(tcp::socket socket) {
    if (server_.connections >= server_.options.max_connections) {
      server_.state.count(&WebCounts::refused_full);
      return;
    }
    error_code failed;
    const auto here = socket.local_endpoint(failed).address();
    if (failed) return;
    // Frames are small and must be sent without delay.
    socket.set_option(tcp::no_delay(true), failed);
    const AccessPolicy policy{.address = here.to_string(),
                              .loopback = here.is_loopback(),
                              .port = server_.port,
                              .token = server_.options.token};
    std::make_shared<FetchSession>(std::move(socket), policy, server_)->read();
  }

  void wait_for_wake() {
    wake_.async_wait(asio::posix::stream_descriptor::wait_read, [this](error_code) {
      awaits_wake_ = false;
      std::uint64_t rung = 0;
      [[maybe_unused]] const ssize_t got =
          read(wake_.native_handle(), &rung, sizeof rung);
      wait_for_wake();
      for (PageSession* page : server_.pages) page->send_next();
    });
    awaits_wake_ = true;
  }

  ServerState server_;
  asio::io_context io_{1};
  tcp::acceptor acceptor_{io_};
  asio::steady_timer pause_{io_};
  asio::posix::stream_descriptor wake_;
  bool accepts_ = false;  ///< An accept is pending, or a pause before it.
  bool awaits_wake_ = false;
};

Error cannot_listen(const tcp::endpoint& endpoint, const error_code& failed) {
  const std::string where =
      endpoint.address().to_string() + ":" + std::to_string(endpoint.port());
  if (failed == asio::error::address_in_use) {
    return {Errc::kDevice,
            where,
            "the port is in use by another program",
            "end that program, or choose another port with --port"};
  }
  if (failed == asio::error::access_denied) {
    return {Errc::kDevice,
            where,
            "this user is not allowed to use the port",
            "choose a port above 1023 with --port"};
  }
  return {Errc::kDevice,
          where,
          "cannot listen there: " + failed.message(),
          "choose an address of this machine"};
}

}  // namespace

Result<std::unique_ptr<WebLoop>> WebLoop::listen(WebState& state,
                                                 const WebServerOptions& options,
                                                 int wake_fd) {
  error_code failed;
  const auto address = asio::ip::make_address(options.address, failed);
  if (failed) {
    return bad_input(
        options.address, "this is not a numeric address", "write one such as 127.0.0.1");
  }
  if (!address.is_loopback() && options.token.empty()) {
    return bad_input(options.address,
                     "other machines could open the page without permission",
                     "serve it with an access token (--lan)");
  }
  try {
    auto sockets = std::make_unique<Sockets>(state, options, wake_fd);
    const tcp::endpoint endpoint(address, static_cast<std::uint16_t>(options.port));
    if ((failed = sockets->listen(endpoint))) return cannot_listen(endpoint, failed);
    return std::unique_ptr<WebLoop>(std::move(sockets));
  } catch (const std::exception& error) {
    return Error{Errc::kDevice,
                 options.address,
                 std::string("cannot serve pages: ") + error.what(),
                 "close other programs, which may use up files or memory"};
  }
}

}  // namespace marey::live
