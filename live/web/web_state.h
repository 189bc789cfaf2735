// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "live/web/newest_messages.h"
#include "live/web/text_inbox.h"
#include "live/web/web_content.h"
#include "live/web/web_counts.h"

namespace marey::live {

/// State of a web server without its sockets: content, messages to the pages, and
/// received texts. Every function may be called from any thread; it waits at most for the
/// copy of one message by another thread.
class WebState {
 public:
  /// Send state of one page.
  struct Page {
    ClientId id{};
    NewestMessages::Reader reader;
    bool answer_is_next = true;
  };

  /// Adds or replaces content. Precondition: is_web_path(content.path), bytes not null.
  void put(WebContent content);
  /// Removes content; no effect if there is none at this path.
  void remove(std::string_view path);
  [[nodiscard]] std::optional<WebContent> find(std::string_view path) const;

  /// Stores the newest message of a slot. A scene removes frames and thumbnails.
  /// Precondition: slot < kMessageSlots.
  void publish(std::size_t slot, std::string_view message);

  [[nodiscard]] Page open_page();
  void close_page(const Page& page);
  [[nodiscard]] std::size_t page_count() const;
  /// Stores an answer for one page, replacing an unsent one. No effect if that page is
  /// closed.
  void answer(ClientId client, bool is_binary, std::string_view message);
  /// Appends a text to the queue of one page. If kMaxQueued wait, the
  /// oldest is dropped. No effect if that page is closed.
  void queue(ClientId client, std::string_view message);
  /// Copies the page's next message into `out`; returns false if there is none. The scene
  /// is first; then answers alternate with messages to all pages.
  bool take_message(Page& page, std::string& out, bool& is_binary);

  TextInbox& inbox() { return inbox_; }

  void count(std::uint64_t WebCounts::*what);
  [[nodiscard]] WebCounts counts() const;

  static constexpr std::size_t kMaxQueued = 16;

 private:
  struct Answer {
    std::string message;
    bool waits = false;
  };
  struct Answers {
    Answer text;
    Answer frame;
    std::deque<std::string> queue;
  };
  bool take_answer(Answers& answers, std::string& out, bool& is_binary);

  static constexpr std::size_t kMaxTexts = 256;

  mutable std::mutex content_mutex_;
  std::map<std::string, WebContent, std::less<>> content_;
  mutable std::mutex messages_mutex_;
  NewestMessages messages_;
  std::map<ClientId, Answers> answers_;
  std::uint64_t last_client_ = 0;
  TextInbox inbox_{kMaxTexts};
  mutable std::mutex counts_mutex_;
  WebCounts counts_;
};

}  // namespace marey::live
