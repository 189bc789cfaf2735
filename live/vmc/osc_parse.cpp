// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/vmc/osc_parse.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace marey::live {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::array<std::uint8_t, 8> kBundle{'#', 'b', 'u', 'n', 'd', 'l', 'e', 0};
constexpr std::size_t kBundleHeadBytes = 16;

// Read big-endian words. Precondition: 4 or 8 bytes are available.
std::uint32_t word32(Bytes bytes) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i) word = word << 8 | bytes[i];
  return word;
}
std::uint64_t word64(Bytes bytes) {
  return std::uint64_t{word32(bytes)} << 32 | word32(bytes.subspan(4));
}

std::size_t padded(std::size_t size) {
  return (size + 3) / 4 * 4;
}

std::string_view text_of(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Returns the text at the start of the bytes; `size` is its length with the zeros up to
/// the next multiple of four. nullopt if the terminator or the padding is wrong.
std::optional<std::string_view> first_text(Bytes bytes, std::size_t& size) {
  const auto end = std::ranges::find(bytes, std::uint8_t{0});
  if (end == bytes.end()) return std::nullopt;
  const auto length = static_cast<std::size_t>(end - bytes.begin());
  size = padded(length + 1);
  if (size > bytes.size()) return std::nullopt;
  const Bytes padding = bytes.subspan(length, size - length);
  if (!std::ranges::all_of(padding, [](std::uint8_t byte) { return byte == 0; })) {
    return std::nullopt;
  }
  return text_of(bytes.first(length));
}

/// Returns the size of the argument of this type [bytes]; nullopt if it is invalid.
std::optional<std::size_t> argument_size(char type, Bytes bytes) {
  std::size_t size = 0;
  switch (type) {
    case 'i':
    case 'f':
    case 'c':
    case 'r':
    case 'm':
      size = 4;
      break;
    case 'h':
    case 'd':
    case 't':
      size = 8;
      break;
    case 's':
    case 'S':
      if (!first_text(bytes, size)) return std::nullopt;
      break;
    case 'b':
      if (bytes.size() < 4 || word32(bytes) > bytes.size()) return std::nullopt;
      size = 4 + padded(word32(bytes));
      break;
    case 'T':
    case 'F':
    case 'N':
    case 'I':
    case '[':
    case ']':
      break;
    default:
      return std::nullopt;
  }
  if (size > bytes.size()) return std::nullopt;
  return size;
}

bool fits(std::string_view types, Bytes bytes) {
  for (const char type : types) {
    const auto size = argument_size(type, bytes);
    if (!size) return false;
    bytes = bytes.subspan(*size);
  }
  return bytes.empty();
}

std::optional<OscMessage> message_of(Bytes bytes) {
  std::size_t size = 0;
  OscMessage message;
  const auto address = first_text(bytes, size);
  if (!address || !address->starts_with('/')) return std::nullopt;
  message.address = *address;
  bytes = bytes.subspan(size);
  if (bytes.empty()) return message;
  const auto types = first_text(bytes, size);
  if (!types || !types->starts_with(',')) return std::nullopt;
  message.types = types->substr(1);
  message.bytes = bytes.subspan(size);
  if (!fits(message.types, message.bytes)) return std::nullopt;
  return message;
}

bool is_bundle(Bytes bytes) {
  return bytes.size() >= kBundleHeadBytes &&
         std::ranges::equal(bytes.first(kBundle.size()), kBundle);
}

/// Removes the next element of a bundle from `rest`; nullopt if its size is invalid.
std::optional<Bytes> next_element(Bytes& rest) {
  if (rest.size() < 4) return std::nullopt;
  const std::size_t size = word32(rest);
  rest = rest.subspan(4);
  // An empty element would be neither a message nor a bundle.
  if (size == 0 || size % 4 != 0 || size > rest.size()) return std::nullopt;
  const Bytes element = rest.first(size);
  rest = rest.subspan(size);
  return element;
}

bool is_sound(Bytes bytes, int depth) {
  if (!is_bundle(bytes)) return message_of(bytes).has_value();
  if (depth == kMaxBundleDepth) return false;
  Bytes rest = bytes.subspan(kBundleHeadBytes);
  while (!rest.empty()) {
    const auto element = next_element(rest);
    if (!element || !is_sound(*element, depth + 1)) return false;
  }
  return true;
}

/// Calls `take` with each message. Precondition: is_sound(bytes).
void hand_over(Bytes bytes, const std::function<void(const OscMessage&)>& take) {
  if (!is_bundle(bytes)) {
    take(*message_of(bytes));
    return;
  }
  Bytes rest = bytes.subspan(kBundleHeadBytes);
  while (!rest.empty()) hand_over(*next_element(rest), take);
}

}  // namespace

void OscArguments::take(std::size_t size) {
  types_.remove_prefix(1);
  bytes_ = bytes_.subspan(size);
}

std::optional<std::int32_t> OscArguments::read_int() {
  if (!types_.starts_with('i')) return std::nullopt;
  const auto number = static_cast<std::int32_t>(word32(bytes_));
  take(4);
  return number;
}

std::optional<double> OscArguments::read_number() {
  if (types_.empty()) return std::nullopt;
  double number = 0.0;
  std::size_t size = 4;
  switch (types_.front()) {
    case 'f':
      number = std::bit_cast<float>(word32(bytes_));
      break;
    case 'i':
      number = static_cast<std::int32_t>(word32(bytes_));
      break;
    case 'd':
      size = 8;
      number = std::bit_cast<double>(word64(bytes_));
      break;
    case 'h':
      size = 8;
      number = static_cast<double>(static_cast<std::int64_t>(word64(bytes_)));
      break;
    default:
      return std::nullopt;
  }
  if (!std::isfinite(number)) return std::nullopt;
  take(size);
  return number;
}

std::optional<std::string_view> OscArguments::read_text() {
  if (!types_.starts_with('s') && !types_.starts_with('S')) return std::nullopt;
  std::size_t size = 0;
  const auto text = first_text(bytes_, size);
  if (text) take(size);
  return text;
}

bool is_osc(std::span<const std::uint8_t> packet) {
  return is_sound(packet, 0);
}

bool parse_osc(std::span<const std::uint8_t> packet,
               const std::function<void(const OscMessage&)>& take) {
  if (!is_osc(packet)) return false;
  hand_over(packet, take);
  return true;
}

}  // namespace marey::live
