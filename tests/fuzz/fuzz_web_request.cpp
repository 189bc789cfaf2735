// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The input is the lines of a head: method, target, Host, Origin, Cookie, If-None-Match.
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/base/assert.h"
#include "live/web/authorize_request.h"

namespace {

using namespace marey::live;

constexpr std::string_view kToken = "0123456789abcdef0123456789abcdef";

std::string_view next_line(std::string_view& rest) {
  const auto end = rest.find('\n');
  const std::string_view line = rest.substr(0, end);
  rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
  return line;
}

void check(const RequestHead& head, const AccessPolicy& policy) {
  const RequestVerdict got = authorize_request(head, policy);
  if (got.verdict != Verdict::kAccepted) return;
  MAREY_ASSERT(head.method == "GET" || head.method == "HEAD");
  MAREY_ASSERT(got.path.starts_with('/') && head.target.starts_with(got.path));
  MAREY_ASSERT(head.host == "127.0.0.1:8790" || head.host == "localhost:8790" ||
               head.host == "[::1]:8790");
  MAREY_ASSERT(head.origin.empty() || head.origin.ends_with(head.host));
  if (policy.token.empty()) return;
  MAREY_ASSERT(head.target.find(kToken) != std::string_view::npos ||
               head.cookie.find(kToken) != std::string_view::npos);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  RequestHead head;
  head.method = next_line(rest);
  head.target = next_line(rest);
  head.host = next_line(rest);
  head.origin = next_line(rest);
  head.cookie = next_line(rest);
  for (const char* address : {"127.0.0.1", "::1"}) {
    for (const std::string_view token : {std::string_view(), kToken}) {
      check(head, {.address = address, .loopback = true, .port = 8790, .token = token});
    }
  }
  static_cast<void>(has_etag(next_line(rest), "\"5f2c\""));
  return 0;
}
