// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/web/http_answer.h"

#include <optional>

namespace marey::live {
namespace {

struct HttpStatus {
  int code = 200;
  const char* name = "OK";
};

struct Extras {
  std::string_view host;    ///< Checked; empty: unknown.
  std::string_view token;   ///< To set as a cookie; empty: none.
  std::string_view policy;  ///< Replaces the page's policy; empty: the page's.
  bool keep_alive = false;
  bool is_head = false;
};

void add_header(std::string& head, std::string_view name, std::string_view value) {
  head.append(name).append(": ").append(value).append("\r\n");
}

/// Returns the policy: the page runs only its own scripts and connects only to this
/// server.
std::string content_policy(std::string_view host) {
  std::string policy =
      "default-src 'self'; img-src 'self' blob: data:; style-src 'self' 'unsafe-inline'; "
      "base-uri 'none'; form-action 'none'; frame-ancestors 'none'; object-src 'none'; "
      // Pictures in avatar files are fetched as blobs; some browsers do not count
      // WebSockets as 'self'.
      "connect-src 'self' blob: data:";
  if (!host.empty()) policy.append(" ws://").append(host);
  return policy;
}

/// Returns status line and headers without the empty line at the end.
std::string begin_head(const HttpStatus& status, const Extras& extras) {
  std::string head =
      "HTTP/1.1 " + std::to_string(status.code) + " " + status.name + "\r\n";
  add_header(
      head,
      "Content-Security-Policy",
      extras.policy.empty() ? content_policy(extras.host) : std::string(extras.policy));
  add_header(head, "X-Content-Type-Options", "nosniff");
  add_header(head, "Referrer-Policy", "no-referrer");
  add_header(head, "Cross-Origin-Resource-Policy", "same-origin");
  add_header(head, "Connection", extras.keep_alive ? "keep-alive" : "close");
  if (!extras.token.empty()) {
    add_header(head,
               "Set-Cookie",
               "marey_token=" + std::string(extras.token) +
                   "; HttpOnly; SameSite=Strict; Path=/");
  }
  return head;
}

HttpAnswer words(const HttpStatus& status, const char* text, const Extras& extras) {
  HttpAnswer out;
  auto body = std::make_shared<const std::string>(std::string(text) + "\n");
  out.head = begin_head(status, extras);
  add_header(out.head, "Cache-Control", "no-store");
  add_header(out.head, "Content-Type", "text/plain; charset=utf-8");
  if (status.code == 405) add_header(out.head, "Allow", "GET, HEAD");
  if (status.code == 426) add_header(out.head, "Upgrade", "websocket");
  add_header(out.head, "Content-Length", std::to_string(body->size()));
  out.head += "\r\n";
  if (!extras.is_head) out.body = std::move(body);
  return out;
}

HttpAnswer send(const WebContent& content,
                std::string_view if_none_match,
                const Extras& extras) {
  const bool known = has_etag(if_none_match, content.etag);
  HttpAnswer out;
  out.head = begin_head(known ? HttpStatus{304, "Not Modified"} : HttpStatus{}, extras);
  // The browser revalidates each time; the content is sent only if it changed.
  add_header(out.head, "Cache-Control", content.etag.empty() ? "no-store" : "no-cache");
  if (!content.etag.empty()) add_header(out.head, "ETag", content.etag);
  if (!known) {
    add_header(out.head, "Content-Type", content.content_type);
    if (content.gzipped) add_header(out.head, "Content-Encoding", "gzip");
    add_header(out.head, "Content-Length", std::to_string(content.bytes->size()));
  }
  out.head += "\r\n";
  if (!known && !extras.is_head) out.body = content.bytes;
  return out;
}

}  // namespace

HttpAnswer answer_request(const RequestVerdict& request,
                          const RequestHead& head,
                          std::string_view if_none_match,
                          std::string_view token,
                          bool keep_alive,
                          WebState& state) {
  Extras extras;
  extras.keep_alive = keep_alive;
  extras.is_head = head.method == "HEAD";
  switch (request.verdict) {
    case Verdict::kAccepted:
      break;
    case Verdict::kWrongMethod:
      state.count(&WebCounts::refused_request);
      return words({405, "Method Not Allowed"}, "Only GET and HEAD are allowed.", extras);
    case Verdict::kWrongTarget:
      state.count(&WebCounts::refused_request);
      return words({400, "Bad Request"}, "The path is not valid.", extras);
    case Verdict::kWrongHost:
      state.count(&WebCounts::refused_host);
      return words({403, "Forbidden"},
                   "Wrong host name. Open the address that marey printed.",
                   extras);
    case Verdict::kWrongOrigin:
      state.count(&WebCounts::refused_origin);
      return words(
          {403, "Forbidden"}, "Requests from other sites are not allowed.", extras);
    case Verdict::kWrongToken:
      state.count(&WebCounts::refused_token);
      return words({403, "Forbidden"},
                   "Open the whole address that marey printed, with its token.",
                   extras);
  }
  extras.host = head.host;
  if (request.token_in_query) extras.token = token;
  const std::optional<WebContent> content = state.find(request.path);
  if (!content) return words({404, "Not Found"}, "There is nothing here.", extras);
  extras.policy = content->policy;
  return send(*content, if_none_match, extras);
}

HttpAnswer reject_request(RejectReason why, WebState& state) {
  switch (why) {
    case RejectReason::kMalformed:
      state.count(&WebCounts::refused_request);
      return words({400, "Bad Request"}, "The request is malformed.", {});
    case RejectReason::kHeadTooBig:
      state.count(&WebCounts::refused_request);
      return words(
          {431, "Request Header Fields Too Large"}, "The request is too large.", {});
    case RejectReason::kFull:
      state.count(&WebCounts::refused_full);
      return words({503, "Service Unavailable"},
                   "Too many pages are open. Close one and reload.",
                   {});
    case RejectReason::kNoUpgrade:
      state.count(&WebCounts::refused_request);
      return words({426, "Upgrade Required"}, "This path accepts only WebSockets.", {});
  }
  return {};
}

}  // namespace marey::live
