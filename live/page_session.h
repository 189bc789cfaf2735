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

#include "live/message_rate.h"
#include "live/web_server.h"
#include "live/web_state.h"

// Included by web_loop.cpp alone: Boost.Beast takes long to compile.
namespace marey::live {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using boost::system::error_code;

class PageSession;

/// What all connections share; outlives them, on the server's thread.
struct House {
  WebState& state;
  const WebServerOptions& options;
  int port = 0;
  std::size_t connections = 0;
  std::vector<PageSession*> pages{};
};

/// A seat among the connections.
class Seat {
 public:
  explicit Seat(House& house) : house_(house) { ++house_.connections; }
  ~Seat() { --house_.connections; }
  Seat(const Seat&) = delete;
  Seat& operator=(const Seat&) = delete;
  [[nodiscard]] House& house() const { return house_; }

 private:
  House& house_;
};

/// One page's WebSocket. Its handlers own it, as boost.asio has it: it lives while one of
/// them is due.
class PageSession : public std::enable_shared_from_this<PageSession> {
 public:
  PageSession(beast::tcp_stream stream, std::unique_ptr<Seat> seat)
      : seat_(std::move(seat)), house_(seat_->house()), socket_(std::move(stream)) {
    house_.pages.push_back(this);
  }
  ~PageSession() {
    if (page_) house_.state.close_page(*page_);
    std::erase(house_.pages, this);
  }
  PageSession(const PageSession&) = delete;
  PageSession& operator=(const PageSession&) = delete;

  /// Answers the request that became a WebSocket, and goes on from there.
  void start(const http::request<http::empty_body>& request) {
    beast::get_lowest_layer(socket_).expires_never();
    websocket::stream_base::timeout times{};
    times.handshake_timeout = kHandshakeTime;
    times.idle_timeout = kSilence;
    times.keep_alive_pings = true;
    socket_.set_option(times);
    socket_.read_message_max(kMostMessageBytes);
    socket_.auto_fragment(false);
    socket_.async_accept(request, [self = shared_from_this()](error_code failed) {
      if (!failed) self->begin();
    });
  }

  /// Sends what there is and is new, one message after the other.
  void send_next() {
    if (!page_ || is_sending_ || is_closing_) return;
    bool is_binary = false;
    if (!house_.state.take_message(*page_, outgoing_, is_binary)) return;
    is_sending_ = true;
    socket_.binary(is_binary);
    socket_.async_write(asio::buffer(outgoing_),
                        [self = shared_from_this()](error_code failed, std::size_t) {
                          self->is_sending_ = false;
                          if (failed) return;
                          self->house_.state.count(&WebCounts::sent_messages);
                          self->send_next();
                        });
  }

 private:
  void begin() {
    page_ = house_.state.open_page();
    house_.state.count(&WebCounts::pages_opened);
    socket_.control_callback(
        [this](websocket::frame_type kind, beast::string_view) { hear_control(kind); });
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
        house_.state.count(&WebCounts::malformed_messages);
      }
      // A message that is being written would keep the session alive.
      beast::get_lowest_layer(socket_).close();
      return;
    }
    if (!is_closing_) hear();
    incoming_.consume(incoming_.size());
    read();
  }

  /// Pings are answered by the library, and are messages like others. Of a page that
  /// sends too many not even the end is negotiated: this is called while it is read.
  void hear_control(websocket::frame_type kind) {
    if (kind == websocket::frame_type::close || is_closing_) return;
    if (rate_.allow(MessageRate::Clock::now())) return;
    house_.state.count(&WebCounts::pages_too_loud);
    is_closing_ = true;
    beast::get_lowest_layer(socket_).close();
  }

  void hear() {
    if (!socket_.got_text()) {
      house_.state.count(&WebCounts::malformed_messages);
      return close(websocket::close_code::unknown_data);
    }
    if (!rate_.allow(MessageRate::Clock::now())) {
      house_.state.count(&WebCounts::pages_too_loud);
      return close(websocket::close_code::policy_error);
    }
    const auto data = incoming_.cdata();
    house_.state.inbox().put(page_->id,
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

  static constexpr std::size_t kMostMessageBytes = 16 * 1024;
  static constexpr int kMostMessagesPerSecond = 200;
  static constexpr std::chrono::seconds kHandshakeTime{10};
  /// A page that says nothing for so long, not even that it is there, is gone.
  static constexpr std::chrono::seconds kSilence{30};

  std::unique_ptr<Seat> seat_;
  House& house_;
  /// Without compression, which costs memory and time for each page.
  websocket::stream<beast::tcp_stream, false> socket_;
  std::optional<WebState::Page> page_;
  MessageRate rate_{kMostMessagesPerSecond};
  beast::flat_buffer incoming_{kMostMessageBytes};
  std::string outgoing_;
  bool is_sending_ = false;
  bool is_closing_ = false;
};

}  // namespace marey::live
