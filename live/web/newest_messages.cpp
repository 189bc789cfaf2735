// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/web/newest_messages.h"

#include "core/base/assert.h"

namespace marey::live {

void NewestMessages::put(std::size_t slot, std::string_view message) {
  MAREY_ASSERT(slot < kMessageSlots);
  slots_[slot].message.assign(message);
  slots_[slot].number = ++newest_;
}

void NewestMessages::clear(std::size_t slot) {
  MAREY_ASSERT(slot < kMessageSlots);
  slots_[slot].number = 0;
}

std::size_t NewestMessages::next_slot(const Reader& reader) const {
  constexpr std::size_t kScene = index(MessageSlot::kScene);
  constexpr std::size_t kFrame = index(MessageSlot::kFrame);
  if (has_new(reader, kScene)) return kScene;
  if (reader.frame_is_next && has_new(reader, kFrame)) return kFrame;
  // The oldest pending message of the other slots.
  std::size_t next = kMessageSlots;
  for (std::size_t slot = 0; slot < kMessageSlots; ++slot) {
    if (slot == kFrame || !has_new(reader, slot)) continue;
    if (next == kMessageSlots || slots_[slot].number < slots_[next].number) next = slot;
  }
  if (next == kMessageSlots && has_new(reader, kFrame)) return kFrame;
  return next;
}

bool NewestMessages::take(Reader& reader, std::string& out, bool& is_binary) const {
  const std::size_t slot = next_slot(reader);
  if (slot == kMessageSlots) return false;
  out.assign(slots_[slot].message);
  is_binary = is_binary_slot(slot);
  reader.had[slot] = slots_[slot].number;
  reader.frame_is_next = slot != index(MessageSlot::kFrame);
  return true;
}

}  // namespace marey::live
