// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/web/authorize_request.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "live/web/access_token.h"
#include "live/web/web_content.h"

namespace marey::live {
namespace {

Verdict verdict(const RequestHead& head, const AccessPolicy& policy) {
  return authorize_request(head, policy).verdict;
}

const AccessPolicy kHere{
    .address = "127.0.0.1", .loopback = true, .port = 8790, .token = ""};

TEST(AuthorizeRequest, ReturnsThePathOfAnAllowedRequest) {
  const RequestVerdict got = authorize_request(
      {.method = "GET", .target = "/page.js?v=2?3", .host = "127.0.0.1:8790"}, kHere);
  EXPECT_EQ(got.verdict, Verdict::kAccepted);
  EXPECT_EQ(got.path, "/page.js");
  EXPECT_FALSE(got.token_in_query);
  EXPECT_EQ(verdict({.method = "GET", .target = "*", .host = "localhost:8790"}, kHere),
            Verdict::kWrongTarget);
  EXPECT_EQ(verdict({.method = "get", .target = "/", .host = "localhost:8790"}, kHere),
            Verdict::kWrongMethod);
}

TEST(AuthorizeRequest, AcceptsItsOwnAddresses) {
  struct Case {
    const char* address;
    bool loopback;
    int port;
    const char* host;
    bool ours;
  };
  const Case cases[] = {
      {"127.0.0.1", true, 8790, "127.0.0.1:8790", true},
      {"127.0.0.1", true, 8790, "localhost:8790", true},
      {"127.0.0.1", true, 8790, "localhost:87900", false},
      {"127.0.0.1", true, 8790, "localhost", false},
      {"127.0.0.1", true, 80, "localhost", true},
      {"127.0.0.1", true, 80, "127.0.0.1:80", true},
      {"127.0.0.1", true, 8790, "localhost.evil.example:8790", false},
      {"127.0.0.1", true, 8790, "[::1]:8790", false},
      {"127.0.0.1", true, 8790, "2130706433:8790", false},
      {"127.0.0.1", true, 8790, "127.0.0.1:8790:8790", false},
      {"127.0.0.1", true, 8790, "127.0.0.18790", false},
      {"127.0.0.1", true, 8790, "user@127.0.0.1:8790", false},
      {"127.0.0.1", true, 8790, "", false},
      {"::1", true, 8790, "[::1]:8790", true},
      {"::1", true, 8790, "::1:8790", false},
      {"::1", true, 8790, "[::1:8790", false},
      {"192.168.1.5", false, 8790, "192.168.1.5:8790", true},
      {"192.168.1.5", false, 8790, "localhost:8790", false},
      {"192.168.1.5", false, 8790, "192.168.1.50:8790", false},
  };
  for (const Case& c : cases) {
    const AccessPolicy policy{
        .address = c.address, .loopback = c.loopback, .port = c.port, .token = ""};
    EXPECT_EQ(verdict({.method = "GET", .target = "/", .host = c.host}, policy),
              c.ours ? Verdict::kAccepted : Verdict::kWrongHost)
        << c.host;
  }
}

TEST(AuthorizeRequest, RequiresTheOriginOfItsOwnPage) {
  const auto from = [](const char* origin) {
    return verdict(
        {.method = "GET", .target = "/", .host = "localhost:8790", .origin = origin},
        kHere);
  };
  EXPECT_EQ(from("http://localhost:8790"), Verdict::kAccepted);
  for (const char* other : {"http://127.0.0.1:8790",
                            "https://localhost:8790",
                            "http://localhost",
                            "http://localhost:87901",
                            "http://evil.example",
                            "null"}) {
    EXPECT_EQ(from(other), Verdict::kWrongOrigin) << other;
  }
}

TEST(AuthorizeRequest, RequiresTheTokenInQueryOrCookie) {
  AccessPolicy policy = kHere;
  policy.token = "0123456789abcdef";
  const auto with = [&](const char* target, const char* cookie) {
    return authorize_request(
        {.method = "GET", .target = target, .host = "localhost:8790", .cookie = cookie},
        policy);
  };
  EXPECT_TRUE(with("/?token=0123456789abcdef", "").token_in_query);
  EXPECT_TRUE(with("/?a=b&token=0123456789abcdef&c", "").token_in_query);
  EXPECT_EQ(with("/", "marey_token=0123456789abcdef").verdict, Verdict::kAccepted);
  EXPECT_EQ(with("/", "a=b; marey_token=0123456789abcdef ;c").verdict,
            Verdict::kAccepted);
  EXPECT_FALSE(with("/", "marey_token=0123456789abcdef").token_in_query);
  const std::pair<const char*, const char*> wrong[] = {
      {"/", ""},
      {"/?token=", ""},
      {"/?token=0123456789abcdee", ""},
      {"/?token=0123456789abcdef0", ""},
      {"/?Token=0123456789abcdef", ""},
      {"/token=0123456789abcdef", ""},
      {"/", "token=0123456789abcdef"},
      {"/", "xmarey_token=0123456789abcdef"},
      {"/", "marey_token"},
  };
  for (const auto& [target, cookie] : wrong) {
    EXPECT_EQ(with(target, cookie).verdict, Verdict::kWrongToken) << target << cookie;
  }
}

TEST(AuthorizeRequest, MatchesWholeEtagsAndAWildcard) {
  EXPECT_TRUE(has_etag("\"a\"", "\"a\""));
  EXPECT_TRUE(has_etag("\"b\" ,W/\"a\"", "\"a\""));
  EXPECT_TRUE(has_etag("*", "\"a\""));
  EXPECT_FALSE(has_etag("\"aa\"", "\"a\""));
  EXPECT_FALSE(has_etag("", "\"a\""));
  EXPECT_FALSE(has_etag("*", ""));
}

TEST(AccessToken, IsLongAndNeverTheSame) {
  std::set<std::string> tokens;
  for (int i = 0; i < 100; ++i) {
    const auto token = make_access_token();
    ASSERT_TRUE(token);
    EXPECT_EQ(token->size(), 32U);
    EXPECT_EQ(token->find_first_not_of("0123456789abcdef"), std::string::npos);
    tokens.insert(*token);
  }
  EXPECT_EQ(tokens.size(), 100U);
  EXPECT_TRUE(same_token("abc", "abc"));
  EXPECT_FALSE(same_token("abd", "abc"));
  EXPECT_FALSE(same_token("ab", "abc"));
}

TEST(WebContent, HasPathsOfItsOwnAlone) {
  for (const char* good : {"/", "/page.js", "/media/12", "/a-b_C.9"}) {
    EXPECT_TRUE(is_web_path(good)) << good;
  }
  for (const char* bad : {"", "page.js", "/..", "/a/../b", "/a b", "/a?b", "/%41"}) {
    EXPECT_FALSE(is_web_path(bad)) << bad;
  }
}

}  // namespace
}  // namespace marey::live
