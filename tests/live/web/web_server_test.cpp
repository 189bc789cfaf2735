// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/web/web_server.h"

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "live/web/access_token.h"
#include "live/web/page_embedded.h"
#include "tests/support/program/web_socket.h"

namespace marey::live {
namespace {

using namespace marey::testing;

WebContent text(const std::string& path,
                const std::string& bytes,
                std::string etag = {}) {
  return {path,
          "text/plain; charset=utf-8",
          std::make_shared<const std::string>(bytes),
          false,
          std::move(etag)};
}

/// A server on a free port, with one thing to fetch.
WebServer serve(WebServerOptions options = {}) {
  options.port = 0;
  auto server = WebServer::start(options);
  EXPECT_TRUE(server) << server.error().message();
  server->put(text("/page.js", "let a;", "\"5f2c\""));
  return *std::move(server);
}

TEST(WebServer, ServesOnlyItsOwnFiles) {
  WebServer server = serve();
  const std::string answer = fetch(server.port(), "/page.js");
  EXPECT_EQ(status(answer), 200);
  EXPECT_EQ(body(answer), "let a;");
  EXPECT_EQ(header(answer, "Content-Type"), "text/plain; charset=utf-8");
  EXPECT_EQ(header(answer, "ETag"), "\"5f2c\"");
  EXPECT_EQ(header(answer, "Cache-Control"), "no-cache");
  EXPECT_EQ(header(answer, "Content-Encoding"), "");
  for (const char* path : {"/",
                           "/page.css",
                           "/page.js/",
                           "//page.js",
                           "/../page.js",
                           "/%70age.js",
                           "/media/1",
                           "/etc/passwd",
                           "/page.js%00"}) {
    EXPECT_EQ(status(fetch(server.port(), path)), 404) << path;
  }
}

TEST(WebServer, SendsSecurityHeadersWithThePage) {
  WebServer server = serve();
  const std::string answer = fetch(server.port(), "/page.js");
  const std::string policy = header(answer, "Content-Security-Policy");
  EXPECT_TRUE(policy.starts_with("default-src 'self'; ")) << policy;
  EXPECT_NE(policy.find("frame-ancestors 'none'"), std::string::npos);
  EXPECT_NE(policy.find("connect-src 'self' blob: data: ws://127.0.0.1:" +
                        std::to_string(server.port())),
            std::string::npos)
      << policy;
  EXPECT_EQ(header(answer, "X-Content-Type-Options"), "nosniff");
  EXPECT_EQ(header(answer, "Referrer-Policy"), "no-referrer");
  EXPECT_EQ(header(answer, "Cross-Origin-Resource-Policy"), "same-origin");
}

TEST(WebServer, SendsTheContentsOwnSecurityPolicy) {
  WebServer server = serve();
  WebContent report = text("/report.html", "<p>");
  report.policy = "default-src 'none'";
  server.put(std::move(report));
  EXPECT_EQ(header(fetch(server.port(), "/report.html"), "Content-Security-Policy"),
            "default-src 'none'");
}

TEST(WebServer, SendsNoUnchangedFileAgain) {
  WebServer server = serve();
  const std::string answer =
      fetch(server.port(), "/page.js", "If-None-Match: \"abc\", W/\"5f2c\"\r\n");
  EXPECT_EQ(status(answer), 304);
  EXPECT_EQ(body(answer), "");
  server.put(text("/page.js", "let b;", "\"77\""));
  const std::string changed =
      fetch(server.port(), "/page.js", "If-None-Match: \"5f2c\"\r\n");
  EXPECT_EQ(status(changed), 200);
  EXPECT_EQ(body(changed), "let b;");
}

TEST(WebServer, ForbidsCachingOfMedia) {
  WebServer server = serve();
  server.put(text("/media/7", "first"));
  EXPECT_EQ(header(fetch(server.port(), "/media/7"), "Cache-Control"), "no-store");
  server.put(text("/media/7", "second"));
  EXPECT_EQ(body(fetch(server.port(), "/media/7")), "second");
}

TEST(WebServer, ReturnsTheSizeForHead) {
  WebServer server = serve();
  const std::string answer = fetch(server.port(), "/page.js", {}, "HEAD");
  EXPECT_EQ(status(answer), 200);
  EXPECT_EQ(header(answer, "Content-Length"), "6");
  EXPECT_EQ(body(answer), "");
}

TEST(WebServer, AnswersSeveralRequestsOnOneConnection) {
  WebServer server = serve();
  WebSocketClient client(server.port());
  for (int i = 0; i < 3; ++i) {
    client.send_raw("GET /page.js HTTP/1.1\r\nHost: 127.0.0.1:" +
                    std::to_string(server.port()) + "\r\n\r\n");
    EXPECT_EQ(status(client.receive_head()), 200);
    EXPECT_EQ(client.receive(6), "let a;");
  }
}

TEST(WebServer, ServesThePageThatIsBuiltIn) {
  WebServer server = serve();
  for (WebContent& content : embedded_page()) server.put(std::move(content));
  const std::string answer = fetch(server.port(), "/");
  EXPECT_EQ(status(answer), 200);
  EXPECT_EQ(header(answer, "Content-Type"), "text/html; charset=utf-8");
  EXPECT_EQ(header(answer, "Content-Encoding"), "gzip");
  EXPECT_EQ(body(answer).substr(0, 2), "\x1f\x8b");
  EXPECT_EQ(header(answer, "ETag").size(), 18U);
}

TEST(WebServer, RefusesOtherNamesForItself) {
  WebServer server = serve();
  const std::string port = std::to_string(server.port());
  for (const std::string& good : {"127.0.0.1:" + port, "localhost:" + port}) {
    EXPECT_EQ(status(fetch(server.port(), "/page.js", "Host: " + good + "\r\n")), 200);
  }
  for (const std::string& bad : {std::string("evil.example:") + port,
                                 std::string("127.0.0.1"),
                                 std::string("127.0.0.1:1"),
                                 "127.0.0.1.evil.example:" + port,
                                 "127.0.0.2:" + port,
                                 std::string()}) {
    EXPECT_EQ(status(fetch(server.port(), "/page.js", "Host: " + bad + "\r\n")), 403)
        << bad;
  }
  const std::string twice =
      "Host: 127.0.0.1:" + port + "\r\nHost: 127.0.0.1:" + port + "\r\n";
  EXPECT_NE(status(fetch(server.port(), "/page.js", twice)), 200);
  EXPECT_GE(server.counts().refused_host, 6U);
}

TEST(WebServer, RefusesOtherSites) {
  WebServer server = serve();
  const std::string own = "Origin: http://127.0.0.1:" + std::to_string(server.port());
  EXPECT_EQ(status(fetch(server.port(), "/page.js", own + "\r\n")), 200);
  for (const char* bad : {"http://evil.example", "null", "https://127.0.0.1"}) {
    const std::string origin = "Origin: " + std::string(bad) + "\r\n";
    EXPECT_EQ(status(fetch(server.port(), "/page.js", origin)), 403) << bad;
    EXPECT_EQ(status(WebSocketClient(server.port()).upgrade(origin)), 403) << bad;
  }
  EXPECT_EQ(server.counts().refused_origin, 6U);
}

TEST(WebServer, AcceptsClientsWithTheToken) {
  WebServerOptions options;
  options.token = *make_access_token();
  WebServer server = serve(options);
  EXPECT_EQ(status(fetch(server.port(), "/page.js")), 403);
  EXPECT_EQ(status(fetch(server.port(), "/page.js?token=" + options.token.substr(1))),
            403);
  EXPECT_EQ(status(WebSocketClient(server.port()).upgrade()), 403);
  EXPECT_EQ(server.counts().refused_token, 3U);

  const std::string answer = fetch(server.port(), "/page.js?token=" + options.token);
  EXPECT_EQ(status(answer), 200);
  EXPECT_EQ(header(answer, "Set-Cookie"),
            "marey_token=" + options.token + "; HttpOnly; SameSite=Strict; Path=/");
  const std::string cookie = "Cookie: a=b; marey_token=" + options.token + "\r\n";
  EXPECT_EQ(status(fetch(server.port(), "/page.js", cookie)), 200);
  EXPECT_EQ(status(WebSocketClient(server.port()).upgrade(cookie)), 101);
}

TEST(WebServer, AllowsOnlyReading) {
  WebServer server = serve();
  for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS"}) {
    const std::string answer =
        fetch(server.port(), "/page.js", "Content-Length: 0\r\n", method);
    EXPECT_EQ(status(answer), 405) << method;
    EXPECT_EQ(header(answer, "Allow"), "GET, HEAD");
  }
  EXPECT_EQ(status(fetch(server.port(), "/page.js", "Content-Length: 5\r\n")), 400);
}

TEST(WebServer, RejectsMalformedRequests) {
  WebServer server = serve();
  const std::string long_header = "X-A: " + std::string(9000, 'a') + "\r\n";
  EXPECT_EQ(status(fetch(server.port(), "/page.js", long_header)), 431);
  WebSocketClient noise(server.port());
  noise.send_raw("\x16\x03\x01 this is no HTTP\r\n\r\n");
  EXPECT_EQ(status(noise.receive_all()), 400);
  EXPECT_EQ(server.counts().refused_request, 2U);
  EXPECT_EQ(status(fetch(server.port(), "/page.js")), 200);
}

TEST(WebServer, ReportsAPortInUse) {
  WebServer server = serve();
  WebServerOptions options;
  options.port = server.port();
  const auto second = WebServer::start(options);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, Errc::kDevice);
  EXPECT_EQ(second.error().message(),
            "127.0.0.1:" + std::to_string(server.port()) +
                ": the port is in use by another program. Next: end that program, or "
                "choose another port with --port.");
}

TEST(WebServer, IsOpenToOthersOnlyWithAToken) {
  WebServerOptions options;
  options.port = 0;
  options.address = "0.0.0.0";
  const auto open = WebServer::start(options);
  ASSERT_FALSE(open);
  EXPECT_EQ(open.error().code, Errc::kBadInput);
  options.token = *make_access_token();
  EXPECT_TRUE(WebServer::start(options));
  options.address = "somewhere";
  EXPECT_FALSE(WebServer::start(options));
  options.address = "192.0.2.1";  // Reserved for examples: no machine has it.
  const auto elsewhere = WebServer::start(options);
  ASSERT_FALSE(elsewhere);
  EXPECT_EQ(elsewhere.error().code, Errc::kDevice);
}

TEST(WebServer, FreesItsPortWhenItStops) {
  WebServerOptions options;
  {
    WebServer server = serve();
    options.port = server.port();
    EXPECT_EQ(status(fetch(server.port(), "/page.js")), 200);
    server.stop();
    server.publish_frame("nobody hears this");
    EXPECT_EQ(status(fetch(options.port, "/page.js")), 0);
  }
  EXPECT_TRUE(WebServer::start(options));
}

TEST(WebServer, TurnsConnectionsAwayBeyondItsLimit) {
  WebServerOptions options;
  options.max_connections = 8;
  WebServer server = serve(options);
  std::vector<WebSocketClient> idle;
  for (int i = 0; i < 8; ++i) idle.emplace_back(server.port());
  // Accepted in order: the ninth is after the eight.
  EXPECT_EQ(status(fetch(server.port(), "/page.js")), 0);
  EXPECT_EQ(server.counts().refused_full, 1U);
}

}  // namespace
}  // namespace marey::live
