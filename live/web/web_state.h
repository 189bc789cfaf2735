// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
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

/// All that a web server knows apart from its sockets: what it serves, what it says, what
/// it heard. Every function may be called from any thread and waits no longer than
/// another one takes to copy a message.
class WebState {
 public:
  /// Where one page is in what it is sent.
  struct Page {
    ClientId id{};
    NewestMessages::Reader reader;
    bool answer_is_next = true;
  };

  /// Precondition: is_web_path(content.path), bytes not null.
  void put(WebContent content);
  [[nodiscard]] std::optional<WebContent> find(std::string_view path) const;

  /// Precondition: slot < kMessageSlots. A scene makes frames and thumbnails void.
  void publish(std::size_t slot, std::string_view message);

  [[nodiscard]] Page open_page();
  void close_page(const Page& page);
  [[nodiscard]] std::size_t page_count() const;
  /// For one page alone; newest wins. Nothing when that page is gone.
  void answer(ClientId client, bool is_binary, std::string_view message);
  /// What to send it next, copied into `out`; false: it has everything. The scene comes
  /// first, then answers and what everybody gets in turns.
  bool take_message(Page& page, std::string& out, bool& is_binary);

  TextInbox& inbox() { return inbox_; }

  void count(std::uint64_t WebCounts::*what);
  [[nodiscard]] WebCounts counts() const;

 private:
  struct Answer {
    std::string message;
    bool waits = false;
  };
  struct Answers {
    Answer text;
    Answer frame;
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
