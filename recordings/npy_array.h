// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// Private to recordings/: numpy's .npy files, little-endian and in C's order.
namespace marey::recordings {

using NpyShape = std::vector<std::size_t>;

/// An array: numpy's word for its type ("<f8"), its shape and its bytes, which are as
/// many as type and shape say. Borrows the bytes.
struct NpyArray {
  std::string_view type;
  NpyShape shape;
  std::string_view data;

  [[nodiscard]] std::size_t count() const {
    std::size_t all = 1;
    for (const std::size_t size : shape) all *= size;
    return all;
  }
  /// Precondition: i < count(), and T is as large as the type.
  template <class T>
  [[nodiscard]] T at(std::size_t i) const {
    T value{};
    std::memcpy(&value, data.data() + i * sizeof(T), sizeof(T));
    return value;
  }
};

/// Reads an .npy file of version 1. nullopt: it is none, its type is not one of those
/// that marey writes, its shape has more than four sizes, or its bytes are more or fewer
/// than type and shape say. Allocates nothing that grows with the array.
[[nodiscard]] std::optional<NpyArray> npy_array(std::string_view npy);

/// Bytes of one item; 0: not a type that marey writes.
[[nodiscard]] std::size_t npy_item_bytes(std::string_view type);

/// Appends a code point as UTF-8; what is no code point becomes U+FFFD.
void append_utf8(std::string& text, std::uint32_t point);

}  // namespace marey::recordings
