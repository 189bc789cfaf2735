// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <boost/asio/buffer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "live/vmc/message_rate.h"
#include "live/web/web_server_options.h"
#include "live/web/web_state.h"

// Included only by web_loop.cpp, because Boost.Beast takes long to compile.
namespace marey::live {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using boost::system::error_code;

class PageSession;

/// State that all connections share. It outlives them and is used only on the server's
/// thread.
struct ServerState {
  WebState& state;
  const WebServerOptions& options;
  int port = 0;
  std::size_t connections = 0;
  std::vector<PageSession*> pages{};
};

/// Counts one connection in ServerState::connections while it lives.
class CountedConnection {
 public:
  explicit CountedConnection(ServerState& server) : server_(server) {
    ++server_.connections;
  }
  ~CountedConnection() { --server_.connections; }
  CountedConnection(const CountedConnection&) = delete;
  CountedConnection& operator=(const CountedConnection&) = delete;
  [[nodiscard]] ServerState& server() const { return server_; }

 private:
  ServerState& server_;
};

/// One page's WebSocket. Its pending handlers own it, as is usual with boost.asio: it is
/// destroyed with the last of them.
class PageSession : public std::enable_shared_from_this<PageSession> {
 public:
  PageSession(beast::tcp_stream stream, std::unique_ptr<CountedConnection> connection)
      : connection_(std::move(connection)),
        server_(connection_->server()),
        socket_(std::move(stream)) {
    server_.pages.push_back(this);
  }
  ~PageSession() {
    if (page_) server_.state.close_page(*page_);
    std::erase(server_.pages, this);
  }
  PageSession(const PageSession&) = delete;
  PageSession& operator=(const PageSession&) = delete;

  /// Accepts the upgrade request and starts to read and send.
  void start(const http::request<http::empty_body>& request) {
    beast::get_lowest_layer(socket_).expires_never();
    websocket::stream_base::timeout times{};
    times.handshake_timeout = kHandshakeTime;
    times.idle_timeout = kSilence;
    times.keep_alive_pings = true;
    socket_.set_option(times);
    socket_.read_message_max(kMaxMessageBytes);
    socket_.auto_fragment(false);
    socket_.async_accept(request, [self = shared_from_this()](error_code failed) {
      if (!failed) self->begin();
    });
  }

  /// Sends the new messages, one after the other.
  void send_next() {
    if (!page_ || is_sending_ || is_closing_) return;
    bool is_binary = false;
    if (!server_.state.take_message(*page_, outgoing_, is_binary)) return;
    is_sending_ = true;
    socket_.binary(is_binary);
    socket_.async_write(asio::buffer(outgoing_),
                        [self = shared_from_this()](error_code failed, std::size_t) {
                          self->is_sending_ = false;
                          if (failed) return;
                          self->server_.state.count(&WebCounts::sent_messages);
                          self->send_next();
                        });
  }

 private:
  void begin() {
    page_ = server_.state.open_page();
    server_.state.count(&WebCounts::pages_opened);
    socket_.control_callback(
        [this](websocket::frame_type kind, beast::string_view) { on_control(kind); });
    read();
    send_next();
  }

  void read() {
    socket_.async_read(incoming_,
                       [self = shared_from_this()](error_code failed, std::size_t) {
                         self->on_read(failed);
                       });
  }

  void on_read(error_code failed) {
    if (failed) {
      const bool was_asked_for = failed == websocket::error::closed || is_closing_;
      if (!was_asked_for && failed.category() == websocket_errors()) {
        server_.state.count(&WebCounts::malformed_messages);
      }
      // A pending write would keep the session alive.
      beast::get_lowest_layer(socket_).close();
      return;
    }
    if (!is_closing_) on_message();
    incoming_.consume(incoming_.size());
    read();
  }

  /// Counts a ping or pong towards the message rate; the library answers pings. A page
  /// above the rate is closed without a close handshake, because this runs within a read.
  void on_control(websocket::frame_type kind) {
    if (kind == websocket::frame_type::close || is_closing_) return;
    if (rate_.allow(MessageRate::Clock::now())) return;
    server_.state.count(&WebCounts::pages_over_rate);
    is_closing_ = true;
    beast::get_lowest_layer(socket_).close();
  }

  void on_message() {
    if (!socket_.got_text()) {
      server_.state.count(&WebCounts::malformed_messages);
      return close(websocket::close_code::unknown_data);
    }
    if (!rate_.allow(MessageRate::Clock::now())) {
      server_.state.count(&WebCounts::pages_over_rate);
      return close(websocket::close_code::policy_error);
    }
    const auto data = incoming_.cdata();
    server_.state.inbox().put(page_->id,
                              {static_cast<const char*>(data.data()), data.size()});
  }

  void close(websocket::close_code why) {
    is_closing_ = true;
    socket_.async_close(why, [self = shared_from_this()](error_code) {
      beast::get_lowest_layer(self->socket_).close();
    });
  }

  static const boost::system::error_category& websocket_errors() {
    return make_error_code(websocket::error::closed).category();
  }

  static constexpr std::size_t kMaxMessageBytes = 16 * 1024;
  static constexpr int kMaxMessagesPerSecond = 200;
  static constexpr std::chrono::seconds kHandshakeTime{10};
  /// A page that sends nothing for this time, not even a pong, is closed.
  static constexpr std::chrono::seconds kSilence{30};

  std::unique_ptr<CountedConnection> connection_;
  ServerState& server_;
  /// Without compression, which costs memory and time per page.
  websocket::stream<beast::tcp_stream, false> socket_;
  std::optional<WebState::Page> page_;
  MessageRate rate_{kMaxMessagesPerSecond};
  beast::flat_buffer incoming_{kMaxMessageBytes};
  std::string outgoing_;
  bool is_sending_ = false;
  bool is_closing_ = false;
};

}  // namespace marey::live
