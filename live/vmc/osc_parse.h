// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>

namespace marey::live {

/// Reads the arguments of a message one after the other. Asked for another type than the
/// next one's, or for more than there are, it gives nullopt and stays where it is.
class OscArguments {
 public:
  OscArguments(std::string_view types, std::span<const std::uint8_t> bytes)
      : types_(types), bytes_(bytes) {}

  std::optional<std::int32_t> read_int();       ///< Of ,i alone.
  std::optional<double> read_number();          ///< Of ,f ,d ,i or ,h; finite.
  std::optional<std::string_view> read_text();  ///< Of ,s or ,S.
  [[nodiscard]] bool is_empty() const { return types_.empty(); }

 private:
  void take(std::size_t size);
  std::string_view types_;
  std::span<const std::uint8_t> bytes_;
};

/// A message of a packet, borrowed from its bytes.
struct OscMessage {
  std::string_view address;             ///< Begins with a slash.
  std::string_view types;               ///< Without the comma.
  std::span<const std::uint8_t> bytes;  ///< Of the arguments, as long as `types` wants.

  [[nodiscard]] OscArguments arguments() const { return {types, bytes}; }
};

/// Bundles within bundles that are still read; VMC and OSC in practice have one.
inline constexpr int kDeepestBundle = 4;

/// Whether the bytes are OSC 1.0 through and through: a message, or a bundle of such,
/// none deeper than kDeepestBundle. Sizes, padding and zero bytes are where they must be,
/// types are known, arguments end where their message does. A message without a type
/// string, which some old senders leave out, has no arguments. Time tags are not looked
/// at.
[[nodiscard]] bool is_osc(std::span<const std::uint8_t> packet);

/// Calls `take` with each message, in order, and tells true; of bytes that are not OSC it
/// calls nothing and tells false: strangers' packets count whole or not at all.
///
/// Reads every byte at most twice, never one outside, never beyond the depth above;
/// allocates nothing. (liblo's deserialiser builds messages on the heap and follows
/// bundles to any depth; tests/live/osc_parse_test.cpp has it judge sound packets.)
bool parse_osc(std::span<const std::uint8_t> packet,
               const std::function<void(const OscMessage&)>& take);

}  // namespace marey::live
