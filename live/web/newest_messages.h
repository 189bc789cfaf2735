// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace marey::live {

/// What a page can be sent, one message of each waiting at most. After the scene, which
/// goes before everything else, frames and the others take turns.
inline constexpr std::size_t kMaxThumbnails = 64;
enum class MessageSlot : std::size_t {
  kScene,
  kFrame,
  kStatus,
  kWizard,
  kConstraints,
  kThumbnail,  ///< The first camera's; the others follow.
};
inline constexpr std::size_t kMessageSlots =
    static_cast<std::size_t>(MessageSlot::kThumbnail) + kMaxThumbnails;

[[nodiscard]] constexpr std::size_t index(MessageSlot slot) {
  return static_cast<std::size_t>(slot);
}

/// The newest message of each slot, for any number of readers, each of which knows what
/// it has had. Buffers are kept: nothing is allocated once they have grown. For one
/// thread at a time.
class NewestMessages {
 public:
  /// What one reader has had.
  struct Reader {
    std::array<std::uint64_t, kMessageSlots> had{};
    bool frame_is_next = true;
  };

  /// Replaces what is in the slot. Precondition: slot < kMessageSlots.
  void put(std::size_t slot, std::string_view message);
  /// Empties a slot: what it held is sent to nobody any more.
  void clear(std::size_t slot);

  /// Whether a slot holds what this reader has not had.
  [[nodiscard]] bool has_new(const Reader& reader, std::size_t slot) const {
    return slots_[slot].number > reader.had[slot];
  }

  /// Copies the next message for this reader into `out` and marks it as had; false when
  /// it has everything. Never the same message twice. Linear in slots.
  bool take(Reader& reader, std::string& out, bool& is_binary) const;

 private:
  struct Slot {
    std::string message;
    std::uint64_t number = 0;  ///< Counts all messages together; 0: empty.
  };
  [[nodiscard]] std::size_t next_slot(const Reader& reader) const;

  std::array<Slot, kMessageSlots> slots_;
  std::uint64_t newest_ = 0;
};

/// Whether the message of a slot is binary.
[[nodiscard]] constexpr bool is_binary_slot(std::size_t slot) {
  return slot == index(MessageSlot::kFrame) || slot >= index(MessageSlot::kThumbnail);
}

}  // namespace marey::live
