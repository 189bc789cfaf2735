// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "live/web/web_server.h"
#include "tests/support/program/count_allocations.h"
#include "tests/support/program/web_socket.h"

namespace marey::live {
namespace {

using namespace marey::testing;
using namespace std::chrono_literals;

constexpr int kText = 1;
constexpr int kBinary = 2;
constexpr int kClose = 8;
constexpr int kPing = 9;
constexpr int kPong = 10;

WebServer serve_pages(WebServerOptions options = {}) {
  options.port = 0;
  auto server = WebServer::start(options);
  EXPECT_TRUE(server) << server.error().message();
  return *std::move(server);
}

/// Waits at most 5 s until another thread makes `claim` true. Returns whether it does.
template <class Claim>
bool soon(const Claim& claim) {
  for (int i = 0; i < 500; ++i) {
    if (claim()) return true;
    std::this_thread::sleep_for(10ms);
  }
  return false;
}

TEST(WebPages, ReceiveTheSceneFirst) {
  WebServer server = serve_pages();
  server.publish_text(PageMessage::kStatus, "status");
  server.publish_frame("old frame");
  server.publish_text(PageMessage::kScene, "scene");
  server.publish_frame("frame");
  server.publish_thumbnail(1, "thumbnail");
  for (int connection = 0; connection < 2; ++connection) {
    WebSocketClient page(server.port());
    ASSERT_EQ(status(page.upgrade()), 101);
    std::vector<std::string> got;
    for (int i = 0; i < 4; ++i) {
      const auto message = page.receive_message();
      ASSERT_TRUE(message);
      got.push_back(message->payload);
    }
    EXPECT_EQ(got, (std::vector<std::string>{"scene", "frame", "status", "thumbnail"}));
  }
}

TEST(WebPages, AnswerTheHandshakeOfTheStandardsExample) {
  WebServer server = serve_pages();
  WebSocketClient page(server.port());
  // RFC 6455, 1.3.
  EXPECT_EQ(header(page.upgrade(), "Sec-WebSocket-Accept"),
            "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");
}

TEST(WebPages, ReceivePublishedMessagesWhileTheyAreOpen) {
  WebServer server = serve_pages();
  WebSocketClient page(server.port());
  ASSERT_EQ(status(page.upgrade()), 101);
  for (int i = 0; i < 100; ++i) {
    const std::string frame = "frame " + std::to_string(i);
    server.publish_frame(frame);
    const auto message = page.receive_message();
    ASSERT_TRUE(message);
    EXPECT_EQ(message->opcode, kBinary);
    EXPECT_EQ(message->payload, frame);
  }
  server.publish_text(PageMessage::kWizard, "wizard");
  const auto message = page.receive_message();
  ASSERT_TRUE(message);
  EXPECT_EQ(message->opcode, kText);
}

TEST(WebPages, SkipFramesWithoutDelayToTheServerWhenTheyReadSlowly) {
  WebServer server = serve_pages();
  WebSocketClient slow(server.port());
  ASSERT_EQ(status(slow.upgrade()), 101);
  ASSERT_TRUE(soon([&] { return server.client_count() == 1; }));
  // 100 MB, more than sockets hold.
  std::string frame(100'000, 'f');
  constexpr int kFrames = 1000;
  for (int i = 0; i < kFrames; ++i) {
    frame.replace(0, 4, std::to_string(1000 + i));
    server.publish_frame(frame);
  }
  int got = 0;
  std::string last;
  while (last != "1999") {
    const auto message = slow.receive_message();
    ASSERT_TRUE(message);
    ASSERT_LT(last, message->payload.substr(0, 4));
    last = message->payload.substr(0, 4);
    ++got;
  }
  EXPECT_LT(got, kFrames / 2);
}

TEST(WebPages, ArePublishedToWithoutAllocating) {
  WebServer server = serve_pages();
  WebSocketClient page(server.port());
  ASSERT_EQ(status(page.upgrade()), 101);
  const std::string frame(500, 'f');
  const auto publish = [&] {
    server.publish_frame(frame);
    server.publish_text(PageMessage::kStatus, frame);
    server.publish_thumbnail(3, frame);
  };
  publish();
  ASSERT_TRUE(soon([&] { return server.counts().sent_messages == 3; }));
  server.stop();  // Its thread may allocate.
  const long before = allocations();
  publish();
  EXPECT_EQ(allocations(), before);
}

TEST(WebPages, DeliverTheirTextsInOrder) {
  WebServer server = serve_pages();
  EXPECT_FALSE(server.wait_for_text(0ms));
  for (int half = 0; half < 2; ++half) {
    // One page alone would talk too much.
    WebSocketClient page(server.port());
    ASSERT_EQ(status(page.upgrade()), 101);
    for (int i = 150 * half; i < 150 * (half + 1); ++i) {
      page.send_frame(kText, "text " + std::to_string(i));
    }
    page.send_frame(kPing, "");
    EXPECT_EQ(page.receive_message()->opcode, kPong);
  }
  EXPECT_TRUE(server.wait_for_text(0ms));
  EXPECT_EQ(server.counts().dropped_texts, 44U);
  std::vector<ReceivedText> texts;
  server.take_texts(texts);
  ASSERT_EQ(texts.size(), 256U);
  EXPECT_EQ(texts.front().text, "text 44");
  EXPECT_EQ(texts.back().text, "text 299");
  EXPECT_NE(texts.front().client, texts.back().client);
  EXPECT_FALSE(server.wait_for_text(0ms));
}

TEST(WebPages, AreAnsweredOneByOne) {
  WebServer server = serve_pages();
  WebSocketClient first(server.port());
  ASSERT_EQ(status(first.upgrade()), 101);
  WebSocketClient second(server.port());
  ASSERT_EQ(status(second.upgrade()), 101);
  second.send_frame(kText, "who am I?");
  ASSERT_TRUE(server.wait_for_text(5000ms));
  std::vector<ReceivedText> texts;
  server.take_texts(texts);
  ASSERT_EQ(texts.size(), 1U);
  server.answer_text(texts[0].client, "the second");
  server.publish_text(PageMessage::kStatus, "to all");
  server.answer_frame(ClientId{99}, "for no page");
  EXPECT_EQ(first.receive_message()->payload, "to all");
  EXPECT_EQ(second.receive_message()->payload, "the second");
  EXPECT_EQ(second.receive_message()->payload, "to all");
}

TEST(WebPages, ReceiveQueuedAnswersInOrderAndTheNewestOfTooMany) {
  WebServer server = serve_pages();
  WebSocketClient page(server.port());
  ASSERT_EQ(status(page.upgrade()), 101);
  page.send_frame(kText, "hello");
  ASSERT_TRUE(server.wait_for_text(5000ms));
  std::vector<ReceivedText> texts;
  server.take_texts(texts);
  // The first is large, so that the others wait for it.
  server.queue_text(texts[0].client, std::string(std::size_t{32} << 20, 'x'));
  std::this_thread::sleep_for(50ms);
  for (int i = 0; i < 20; ++i) server.queue_text(texts[0].client, std::to_string(i));
  server.queue_text(ClientId{99}, "for no page");
  EXPECT_EQ(page.receive_message()->payload.size(), std::size_t{32} << 20);
  for (int i = 4; i < 20; ++i) {
    EXPECT_EQ(page.receive_message()->payload, std::to_string(i));
  }
}

TEST(WebPages, ReceiveTheMessagesOfAnEdit) {
  WebServer server = serve_pages();
  server.publish_text(PageMessage::kRevision, "revision 1");
  server.publish_text(PageMessage::kProgress, "progress");
  server.publish_text(PageMessage::kRendered, "rendered");
  server.publish_text(PageMessage::kRevision, "revision 2");
  server.publish_text(PageMessage::kScene, "scene");
  WebSocketClient page(server.port());
  ASSERT_EQ(status(page.upgrade()), 101);
  for (const char* text : {"scene", "progress", "rendered", "revision 2"}) {
    EXPECT_EQ(page.receive_message()->payload, text);
  }
}

TEST(WebPages, AreClosedWhenTheyTalkTooMuch) {
  WebServer server = serve_pages();
  WebSocketClient page(server.port());
  ASSERT_EQ(status(page.upgrade()), 101);
  for (int i = 0; i < 500; ++i) page.send_frame(kText, "text");
  const auto end = page.receive_message();
  ASSERT_TRUE(end);
  EXPECT_EQ(end->opcode, kClose);
  EXPECT_EQ(end->payload.substr(0, 2), "\x03\xf0");  // 1008.
  EXPECT_EQ(server.counts().pages_over_rate, 1U);
}

TEST(WebPages, AreCutOffWhenTheyPingTooMuch) {
  WebServer server = serve_pages();
  WebSocketClient page(server.port());
  ASSERT_EQ(status(page.upgrade()), 101);
  for (int i = 0; i < 150; ++i) page.send_frame(kPing, "");
  for (int i = 0; i < 150; ++i) {
    const auto answer = page.receive_message();
    ASSERT_TRUE(answer) << i;
    ASSERT_EQ(answer->opcode, kPong);
  }
  EXPECT_EQ(server.counts().pages_over_rate, 0U);
  for (int i = 0; i < 300; ++i) page.send_frame(kPing, "");
  EXPECT_TRUE(soon([&] { return server.counts().pages_over_rate == 1U; }));
  while (const auto answer = page.receive_message()) EXPECT_EQ(answer->opcode, kPong);
}

TEST(WebPages, AreClosedAfterAMalformedMessage) {
  WebServer server = serve_pages();
  struct Case {
    const char* what;
    std::string bytes;
  };
  const Case cases[] = {
      {"not masked", std::string("\x81\x02hi", 4)},
      {"an undefined opcode", std::string("\x83\x80mask", 6)},
      {"reserved bits", std::string("\xf1\x80mask", 6)},
      {"too large", std::string("\x81\xfe\x40\x01mask", 8)},
      {"far too large", std::string("\x81\xff\x7f\xff\xff\xff\xff\xff\xff\xff mask", 14)},
      {"a long ping", std::string("\x89\xfe\x01\x00mask", 8)},
      {"no UTF-8", std::string("\x81\x82\0\0\0\0\xff\xfe", 8)},
  };
  std::uint64_t malformed = 0;
  for (const Case& c : cases) {
    {
      WebSocketClient page(server.port());
      ASSERT_EQ(status(page.upgrade()), 101);
      page.send_raw(c.bytes);
      const auto end = page.receive_message();
      EXPECT_TRUE(!end || end->opcode == kClose) << c.what;
    }
    ++malformed;
    EXPECT_TRUE(soon([&] { return server.counts().malformed_messages == malformed; }))
        << c.what;
  }
  WebSocketClient page(server.port());
  ASSERT_EQ(status(page.upgrade()), 101);
  page.send_frame(kBinary, "binary");
  EXPECT_EQ(page.receive_message()->opcode, kClose);
  EXPECT_EQ(server.counts().malformed_messages, malformed + 1);
  EXPECT_FALSE(server.wait_for_text(0ms));
}

TEST(WebPages, AreRemovedWhenTheyDisconnect) {
  WebServer server = serve_pages();
  {
    WebSocketClient polite(server.port());
    ASSERT_EQ(status(polite.upgrade()), 101);
    WebSocketClient rude(server.port());
    ASSERT_EQ(status(rude.upgrade()), 101);
    EXPECT_TRUE(soon([&] { return server.client_count() == 2; }));
    polite.send_frame(kClose, "\x03\xe8");
    EXPECT_EQ(polite.receive_message()->opcode, kClose);
  }
  EXPECT_TRUE(soon([&] { return server.client_count() == 0; }));
  EXPECT_EQ(server.counts().malformed_messages, 0U);
}

TEST(WebPages, AreTurnedAwayBeyondTheirLimit) {
  WebServerOptions options;
  options.max_clients = 2;
  WebServer server = serve_pages(options);
  std::vector<WebSocketClient> pages;
  for (int i = 0; i < 2; ++i) {
    pages.emplace_back(server.port());
    EXPECT_EQ(status(pages.back().upgrade()), 101);
  }
  EXPECT_EQ(status(WebSocketClient(server.port()).upgrade()), 503);
  EXPECT_EQ(server.counts().refused_full, 1U);
  pages.clear();
  EXPECT_TRUE(
      soon([&] { return status(WebSocketClient(server.port()).upgrade()) == 101; }));
}

TEST(WebPages, HaveAPathThatCannotBeFetched) {
  WebServer server = serve_pages();
  EXPECT_EQ(status(fetch(server.port(), "/live")), 426);
}

}  // namespace
}  // namespace marey::live
