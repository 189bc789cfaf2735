// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace marey::live {

/// Kinds of messages to a page; at most one of each is pending. The scene is sent first.
/// Frames and the other messages then alternate.
inline constexpr std::size_t kMaxThumbnails = 64;
enum class MessageSlot : std::size_t {
  kScene,
  kFrame,
  kStatus,
  kWizard,
  kConstraints,
  kRun,
  kTargets,
  kRevision,
  kProgress,
  kRendered,
  kThumbnail,  ///< Slot of the first camera; the others follow.
};
inline constexpr std::size_t kMessageSlots =
    static_cast<std::size_t>(MessageSlot::kThumbnail) + kMaxThumbnails;

[[nodiscard]] constexpr std::size_t index(MessageSlot slot) {
  return static_cast<std::size_t>(slot);
}

/// Stores the newest message of each slot for any number of readers; each reader records
/// the messages that it has received. Buffers are reused: nothing is allocated once they
/// have grown. Used by one thread at a time.
class NewestMessages {
 public:
  /// Numbers of the messages that one reader has received.
  struct Reader {
    std::array<std::uint64_t, kMessageSlots> had{};
    bool frame_is_next = true;
  };

  /// Replaces the message in the slot. Precondition: slot < kMessageSlots.
  void put(std::size_t slot, std::string_view message);
  /// Empties a slot: its message is not sent any more.
  void clear(std::size_t slot);

  /// Returns true if the slot's message is new to this reader.
  [[nodiscard]] bool has_new(const Reader& reader, std::size_t slot) const {
    return slots_[slot].number > reader.had[slot];
  }

  /// Copies the next message for this reader into `out` and marks it as received; returns
  /// false if there is none. Never returns a message twice. Linear in slots.
  bool take(Reader& reader, std::string& out, bool& is_binary) const;

 private:
  struct Slot {
    std::string message;
    std::uint64_t number = 0;  ///< Serial number over all slots; 0: empty.
  };
  [[nodiscard]] std::size_t next_slot(const Reader& reader) const;

  std::array<Slot, kMessageSlots> slots_;
  std::uint64_t newest_ = 0;
};

/// Returns true if the message of a slot is binary.
[[nodiscard]] constexpr bool is_binary_slot(std::size_t slot) {
  return slot == index(MessageSlot::kFrame) || slot >= index(MessageSlot::kThumbnail);
}

}  // namespace marey::live
