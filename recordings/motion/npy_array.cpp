// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/motion/npy_array.h"

#include <algorithm>
#include <array>

#include "recordings/base/text_reader.h"

namespace marey::recordings {
namespace {

/// Returns the text after 'key': in the header of an .npy, without leading blanks.
std::string_view value_of(std::string_view head, std::string_view key) {
  const std::size_t at = head.find(key);
  if (at == std::string_view::npos) return {};
  head.remove_prefix(at + key.size());
  head.remove_prefix(std::min(head.find_first_not_of(": "), head.size()));
  return head;
}

/// Parses "(3, 22)". nullopt: no shape, or one of more than four dimensions.
std::optional<NpyShape> shape_of(std::string_view text) {
  constexpr std::size_t kMaxRank = 4;
  if (!text.starts_with('(')) return std::nullopt;
  text = text.substr(1, text.find(')') - 1);
  NpyShape shape;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(','), text.size());
    const std::string_view word = text.substr(0, end);
    const std::size_t blank = word.find_first_not_of(' ');
    text.remove_prefix(std::min(end + 1, text.size()));
    if (blank == std::string_view::npos) continue;
    const auto size = to_integer(word.substr(blank));
    if (!size || *size < 0 || shape.size() == kMaxRank) return std::nullopt;
    shape.push_back(static_cast<std::size_t>(*size));
  }
  return shape;
}

}  // namespace

std::size_t npy_item_bytes(std::string_view type) {
  if (type == "<f8" || type == "<i8") return 8;
  if (type == "<i4" || type == "<f4") return 4;
  if (type == "|u1" || type == "|b1") return 1;
  if (!type.starts_with("<U")) return 0;
  const auto letters = to_integer(type.substr(2));
  return letters && *letters > 0 ? 4 * static_cast<std::size_t>(*letters) : 0;
}

std::optional<NpyArray> npy_array(std::string_view npy) {
  constexpr std::size_t kBefore = 10;
  if (npy.size() < kBefore || !npy.starts_with("\x93NUMPY\x01")) return std::nullopt;
  const std::size_t length = static_cast<unsigned char>(npy[8]) |
                             static_cast<std::size_t>(static_cast<unsigned char>(npy[9]))
                                 << 8U;
  if (length > npy.size() - kBefore) return std::nullopt;
  const std::string_view head = npy.substr(kBefore, length);
  const std::string_view type = value_of(head, "'descr'");
  const auto shape = shape_of(value_of(head, "'shape'"));
  if (!shape || !type.starts_with('\'')) return std::nullopt;
  if (!value_of(head, "'fortran_order'").starts_with("False")) return std::nullopt;
  NpyArray array{
      type.substr(1, type.find('\'', 1) - 1), *shape, npy.substr(kBefore + length)};
  // Divided step by step, so that no product of the file's numbers can overflow.
  std::size_t left = array.data.size();
  const std::size_t item = npy_item_bytes(array.type);
  if (item == 0) return std::nullopt;
  std::size_t product = item;
  for (const std::size_t size : array.shape) {
    if (size > 0 && product > left / size) return std::nullopt;
    product *= size;
  }
  if (product != left) return std::nullopt;
  return array;
}

void append_utf8(std::string& text, std::uint32_t point) {
  if (point < 0x80) {
    text += static_cast<char>(point);
    return;
  }
  if (point > 0x10ffff || (point >= 0xd800 && point < 0xe000)) point = 0xfffd;
  const unsigned more = point < 0x800 ? 1 : point < 0x10000 ? 2 : 3;
  constexpr std::array<unsigned, 4> kHeads{0, 0xc0, 0xe0, 0xf0};
  text += static_cast<char>(kHeads[more] | (point >> (6U * more)));
  for (unsigned k = more; k-- > 0;) {
    text += static_cast<char>(0x80U | ((point >> (6U * k)) & 0x3fU));
  }
}

}  // namespace marey::recordings
