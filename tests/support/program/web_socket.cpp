// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/program/web_socket.h"

#include <cstdint>
#include <cstdlib>
#include <utility>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

namespace marey::testing {

WebSocketClient::WebSocketClient(int port)
    : socket_(::socket(AF_INET, SOCK_STREAM, 0)), port_(port) {
  constexpr timeval kPatience{.tv_sec = 5, .tv_usec = 0};
  setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &kPatience, sizeof kPatience);
  setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &kPatience, sizeof kPatience);
  sockaddr_in there{};
  there.sin_family = AF_INET;
  there.sin_port = htons(static_cast<std::uint16_t>(port));
  there.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(socket_, reinterpret_cast<const sockaddr*>(&there), sizeof there) != 0) {
    ::close(std::exchange(socket_, -1));
  }
}

WebSocketClient::WebSocketClient(WebSocketClient&& other) noexcept
    : socket_(std::exchange(other.socket_, -1)), port_(other.port_) {}

WebSocketClient::~WebSocketClient() {
  if (socket_ >= 0) ::close(socket_);
}

void WebSocketClient::send_raw(std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t sent = send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return;
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
}

std::string WebSocketClient::receive(std::size_t size) {
  std::string out(size, '\0');
  std::size_t got = 0;
  while (got < size) {
    const ssize_t read = recv(socket_, out.data() + got, size - got, 0);
    if (read <= 0) break;
    got += static_cast<std::size_t>(read);
  }
  out.resize(got);
  return out;
}

std::string WebSocketClient::receive_all() {
  std::string out;
  for (std::string one = receive(1); !one.empty(); one = receive(1)) out += one;
  return out;
}

std::string WebSocketClient::receive_head() {
  std::string head;
  while (!head.ends_with("\r\n\r\n")) {
    const std::string one = receive(1);
    if (one.empty()) break;
    head += one;
  }
  return head;
}

std::string WebSocketClient::upgrade(std::string_view extra_headers) {
  send_raw(
      "GET /live HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port_) +
      "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n" +
      std::string(extra_headers) + "\r\n");
  return receive_head();
}

void WebSocketClient::send_frame(int opcode,
                                 std::string_view payload,
                                 bool masked) const {
  std::string frame(1, static_cast<char>(0x80 | opcode));
  const unsigned mask_bit = masked ? 0x80U : 0U;
  if (payload.size() < 126) {
    frame += static_cast<char>(mask_bit | payload.size());
  } else {
    frame += static_cast<char>(mask_bit | 126U);
    frame += static_cast<char>(payload.size() >> 8U);
    frame += static_cast<char>(payload.size() & 0xFFU);
  }
  constexpr std::string_view kMask = "mask";
  if (masked) frame += kMask;
  for (std::size_t i = 0; i < payload.size(); ++i) {
    frame += masked ? static_cast<char>(payload[i] ^ kMask[i % 4]) : payload[i];
  }
  send_raw(frame);
}

std::optional<WebSocketClient::Message> WebSocketClient::receive_message() {
  for (;;) {
    const std::string start = receive(2);
    if (start.size() < 2) return std::nullopt;
    const int opcode = start[0] & 0x0F;
    std::uint64_t size = static_cast<unsigned char>(start[1]);
    if (size >= 126) {
      const std::string wide = receive(size == 126 ? 2 : 8);
      size = 0;
      for (const char c : wide) size = (size << 8U) | static_cast<unsigned char>(c);
    }
    std::string payload = receive(size);
    if (payload.size() < size) return std::nullopt;
    constexpr int kPing = 9;
    if (opcode != kPing) return Message{opcode, std::move(payload)};
  }
}

std::string fetch(int port,
                  std::string_view path,
                  std::string_view headers,
                  std::string_view method) {
  WebSocketClient client(port);
  std::string request = std::string(method) + " " + std::string(path) + " HTTP/1.1\r\n";
  if (headers.find("Host:") == std::string_view::npos) {
    request += "Host: 127.0.0.1:" + std::to_string(port) + "\r\n";
  }
  client.send_raw(request + std::string(headers) + "Connection: close\r\n\r\n");
  return client.receive_all();
}

std::string header(const std::string& answer, std::string_view name) {
  const std::string start = "\r\n" + std::string(name) + ": ";
  const auto at = answer.find(start);
  if (at == std::string::npos || at > answer.find("\r\n\r\n")) return {};
  const auto from = at + start.size();
  return answer.substr(from, answer.find("\r\n", from) - from);
}

std::string body(const std::string& answer) {
  const auto at = answer.find("\r\n\r\n");
  return at == std::string::npos ? std::string() : answer.substr(at + 4);
}

int status(const std::string& answer) {
  constexpr std::string_view kStart = "HTTP/1.1 ";
  return answer.starts_with(kStart) ? std::atoi(answer.c_str() + kStart.size()) : 0;
}

}  // namespace marey::testing
