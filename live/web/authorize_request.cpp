// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/web/authorize_request.h"

#include <array>
#include <charconv>

#include "live/web/access_token.h"

namespace marey::live {
namespace {

constexpr std::string_view kTokenQuery = "token";
constexpr std::string_view kTokenCookie = "marey_token";

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Removes the part up to `mark` from the front of `rest` and returns it.
std::string_view take_until(char mark, std::string_view& rest) {
  const auto end = rest.find(mark);
  const std::string_view part = rest.substr(0, end);
  rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
  return part;
}

std::string_view value_of(std::string_view list, char mark, std::string_view name) {
  while (!list.empty()) {
    std::string_view value = trimmed(take_until(mark, list));
    if (take_until('=', value) == name) return value;
  }
  return {};
}

/// Removes `start` from the front of `text`; returns false if `text` begins differently.
bool take_start(std::string_view start, std::string_view& text) {
  if (!text.starts_with(start)) return false;
  text.remove_prefix(start.size());
  return true;
}

/// Returns true if `text` is ":port", or is empty and the port is 80, which browsers
/// omit.
bool is_port(std::string_view text, int port) {
  constexpr int kUsual = 80;
  if (text.empty()) return port == kUsual;
  std::array<char, 8> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), port).ptr;
  const std::string_view wanted(digits.data(),
                                static_cast<std::size_t>(end - digits.data()));
  return text.front() == ':' && text.substr(1) == wanted;
}

bool is_our_host(std::string_view host, const AccessPolicy& policy) {
  if (policy.loopback) {
    std::string_view rest = host;
    if (take_start("localhost", rest) && is_port(rest, policy.port)) return true;
  }
  const bool brackets = policy.address.find(':') != std::string::npos;
  std::string_view rest = host;
  if (brackets && !take_start("[", rest)) return false;
  if (!take_start(policy.address, rest)) return false;
  if (brackets && !take_start("]", rest)) return false;
  return is_port(rest, policy.port);
}

bool is_our_origin(std::string_view origin, std::string_view host) {
  return origin.empty() || (take_start("http://", origin) && origin == host);
}

}  // namespace

std::string_view cookie_value(std::string_view cookies, std::string_view name) {
  return value_of(cookies, ';', name);
}

std::string_view query_value(std::string_view query, std::string_view name) {
  return value_of(query, '&', name);
}

bool has_etag(std::string_view if_none_match, std::string_view etag) {
  if (etag.empty()) return false;
  while (!if_none_match.empty()) {
    std::string_view one = trimmed(take_until(',', if_none_match));
    take_start("W/", one);
    if (one == etag || one == "*") return true;
  }
  return false;
}

RequestVerdict authorize_request(const RequestHead& head, const AccessPolicy& policy) {
  RequestVerdict out;
  std::string_view query = head.target;
  out.path = take_until('?', query);
  if (!is_our_host(head.host, policy)) {
    out.verdict = Verdict::kWrongHost;
  } else if (!is_our_origin(head.origin, head.host)) {
    out.verdict = Verdict::kWrongOrigin;
  } else {
    out.token_in_query = !policy.token.empty() &&
                         same_token(query_value(query, kTokenQuery), policy.token);
    const bool known = policy.token.empty() || out.token_in_query ||
                       same_token(cookie_value(head.cookie, kTokenCookie), policy.token);
    if (!known) {
      out.verdict = Verdict::kWrongToken;
    } else if (head.method != "GET" && head.method != "HEAD") {
      out.verdict = Verdict::kWrongMethod;
    } else {
      out.verdict =
          out.path.starts_with('/') ? Verdict::kAccepted : Verdict::kWrongTarget;
    }
  }
  return out;
}

}  // namespace marey::live
