// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>

namespace marey::live {

/// Reads the arguments of a message in order. A read of another type than the next
/// argument's, or past the end, returns nullopt and does not advance.
class OscArguments {
 public:
  OscArguments(std::string_view types, std::span<const std::uint8_t> bytes)
      : types_(types), bytes_(bytes) {}

  std::optional<std::int32_t> read_int();       ///< Reads ,i only.
  std::optional<double> read_number();          ///< Reads ,f ,d ,i or ,h; finite.
  std::optional<std::string_view> read_text();  ///< Reads ,s or ,S.
  [[nodiscard]] bool is_empty() const { return types_.empty(); }

 private:
  void take(std::size_t size);
  std::string_view types_;
  std::span<const std::uint8_t> bytes_;
};

/// A message of a packet; a view into the packet's bytes.
struct OscMessage {
  std::string_view address;             ///< Begins with a slash.
  std::string_view types;               ///< Type string without the comma.
  std::span<const std::uint8_t> bytes;  ///< Arguments; the length matches `types`.

  [[nodiscard]] OscArguments arguments() const { return {types, bytes}; }
};

/// Maximum depth of nested bundles. VMC and OSC in practice have depth 1.
inline constexpr int kMaxBundleDepth = 4;

/// Returns true if the bytes are valid OSC 1.0: a message, or a bundle of messages and
/// bundles, not deeper than kMaxBundleDepth. Sizes, padding and zero bytes must be
/// correct, types must be known, and arguments must end where their message ends. A
/// message without a type string (some old senders omit it) has no arguments. Time tags
/// are ignored.
[[nodiscard]] bool is_osc(std::span<const std::uint8_t> packet);

/// Calls `take` with each message, in order, and returns true. For bytes that are not OSC
/// it calls nothing and returns false, so a packet is used completely or not at all.
///
/// Reads every byte at most twice, never outside the packet, never beyond the depth
/// above; allocates nothing. (liblo's deserialiser builds messages on the heap and
/// follows bundles to any depth; tests/live/vmc/osc_parse_test.cpp compares valid packets
/// with it.)
bool parse_osc(std::span<const std::uint8_t> packet,
               const std::function<void(const OscMessage&)>& take);

}  // namespace marey::live
