// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/web/web_state.h"

#include <utility>

#include "core/base/assert.h"

namespace marey::live {

void WebState::put(WebContent content) {
  MAREY_ASSERT(is_web_path(content.path) && content.bytes != nullptr);
  const std::lock_guard lock(content_mutex_);
  std::string path = content.path;
  content_.insert_or_assign(std::move(path), std::move(content));
}

void WebState::remove(std::string_view path) {
  const std::lock_guard lock(content_mutex_);
  const auto found = content_.find(path);
  if (found != content_.end()) content_.erase(found);
}

std::optional<WebContent> WebState::find(std::string_view path) const {
  const std::lock_guard lock(content_mutex_);
  const auto found = content_.find(path);
  if (found == content_.end()) return std::nullopt;
  return found->second;
}

void WebState::publish(std::size_t slot, std::string_view message) {
  const std::lock_guard lock(messages_mutex_);
  if (slot == index(MessageSlot::kScene)) {
    messages_.clear(index(MessageSlot::kFrame));
    for (std::size_t i = 0; i < kMaxThumbnails; ++i) {
      messages_.clear(index(MessageSlot::kThumbnail) + i);
    }
  }
  messages_.put(slot, message);
}

WebState::Page WebState::open_page() {
  const std::lock_guard lock(messages_mutex_);
  Page page;
  page.id = ClientId{++last_client_};
  answers_.try_emplace(page.id);
  return page;
}

void WebState::close_page(const Page& page) {
  const std::lock_guard lock(messages_mutex_);
  answers_.erase(page.id);
}

std::size_t WebState::page_count() const {
  const std::lock_guard lock(messages_mutex_);
  return answers_.size();
}

void WebState::answer(ClientId client, bool is_binary, std::string_view message) {
  const std::lock_guard lock(messages_mutex_);
  const auto found = answers_.find(client);
  if (found == answers_.end()) return;
  Answer& answer = is_binary ? found->second.frame : found->second.text;
  answer.message.assign(message);
  answer.waits = true;
}

void WebState::queue(ClientId client, std::string_view message) {
  const std::lock_guard lock(messages_mutex_);
  const auto found = answers_.find(client);
  if (found == answers_.end()) return;
  std::deque<std::string>& queue = found->second.queue;
  if (queue.size() >= kMaxQueued) queue.pop_front();
  queue.emplace_back(message);
}

bool WebState::take_answer(Answers& answers, std::string& out, bool& is_binary) {
  if (!answers.queue.empty()) {
    out = std::move(answers.queue.front());
    answers.queue.pop_front();
    is_binary = false;
    return true;
  }
  Answer& answer = answers.text.waits ? answers.text : answers.frame;
  if (!answer.waits) return false;
  out.assign(answer.message);
  is_binary = &answer == &answers.frame;
  answer.waits = false;
  return true;
}

bool WebState::take_message(Page& page, std::string& out, bool& is_binary) {
  const std::lock_guard lock(messages_mutex_);
  const auto found = answers_.find(page.id);
  if (found == answers_.end()) return false;
  const bool scene_waits = messages_.has_new(page.reader, index(MessageSlot::kScene));
  if (page.answer_is_next && !scene_waits && take_answer(found->second, out, is_binary)) {
    page.answer_is_next = false;
    return true;
  }
  page.answer_is_next = true;
  return messages_.take(page.reader, out, is_binary) ||
         take_answer(found->second, out, is_binary);
}

void WebState::count(std::uint64_t WebCounts::*what) {
  const std::lock_guard lock(counts_mutex_);
  ++(counts_.*what);
}

WebCounts WebState::counts() const {
  const std::lock_guard lock(counts_mutex_);
  WebCounts out = counts_;
  out.dropped_texts = inbox_.dropped();
  return out;
}

}  // namespace marey::live
