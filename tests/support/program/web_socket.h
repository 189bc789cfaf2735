// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace marey::testing {

/// A browser's end of a connection, by hand: blocking sockets and nothing of Boost's.
/// Whatever does not happen within a few seconds counts as not happening.
class WebSocketClient {
 public:
  /// Connects to 127.0.0.1.
  explicit WebSocketClient(int port);
  ~WebSocketClient();
  WebSocketClient(const WebSocketClient&) = delete;
  WebSocketClient& operator=(const WebSocketClient&) = delete;
  WebSocketClient(WebSocketClient&& other) noexcept;

  void send_raw(std::string_view bytes) const;
  /// Exactly so many bytes; fewer when the other end closed.
  [[nodiscard]] std::string receive(std::size_t size);
  /// All until the other end closes.
  [[nodiscard]] std::string receive_all();
  /// Status line and headers, up to and with the empty line.
  [[nodiscard]] std::string receive_head();

  /// Asks for /live and takes the answer's head.
  [[nodiscard]] std::string upgrade(std::string_view extra_headers = {});
  /// A masked frame of a client. `opcode`: 1 text, 2 binary, 8 close, 9 ping.
  void send_frame(int opcode, std::string_view payload, bool masked = true) const;
  struct Message {
    int opcode = 0;
    std::string payload;
  };
  /// The next frame of the server's that is no ping; nullopt: it closed.
  [[nodiscard]] std::optional<Message> receive_message();

 private:
  int socket_ = -1;
  int port_ = 0;
};

/// One request on a connection of its own, all of the answer. Headers each end with
/// "\r\n"; without a Host among them, the right one is added.
[[nodiscard]] std::string fetch(int port,
                                std::string_view path,
                                std::string_view headers = {},
                                std::string_view method = "GET");

/// The value of a header in an answer; empty: it has none.
[[nodiscard]] std::string header(const std::string& answer, std::string_view name);
/// Returns the part of an answer after its headers.
[[nodiscard]] std::string body(const std::string& answer);
/// 200, 404...; 0: no answer.
[[nodiscard]] int status(const std::string& answer);

}  // namespace marey::testing
