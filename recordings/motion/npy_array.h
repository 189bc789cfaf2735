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

// Private to recordings/: numpy's .npy files, little-endian and in C order.
namespace marey::recordings {

using NpyShape = std::vector<std::size_t>;

/// An array: numpy's word for its type ("<f8"), its shape and its bytes, whose number
/// matches type and shape. Borrows the bytes.
struct NpyArray {
  std::string_view type;
  NpyShape shape;
  std::string_view data;

  [[nodiscard]] std::size_t count() const {
    std::size_t all = 1;
    for (const std::size_t size : shape) all *= size;
    return all;
  }
  /// Returns item i. Preconditions: i < count(); T has the size of the type.
  template <class T>
  [[nodiscard]] T at(std::size_t i) const {
    T value{};
    std::memcpy(&value, data.data() + i * sizeof(T), sizeof(T));
    return value;
  }
};

/// Reads an .npy file of version 1. Returns nullopt if it is none, if marey does not
/// write its type, if its shape has more than four dimensions, or if the number of bytes
/// differs from type and shape. Allocates no memory proportional to the array.
[[nodiscard]] std::optional<NpyArray> npy_array(std::string_view npy);

/// Returns the bytes of one item; 0 if marey does not write this type.
[[nodiscard]] std::size_t npy_item_bytes(std::string_view type);

/// Appends a code point as UTF-8; an invalid code point becomes U+FFFD.
void append_utf8(std::string& text, std::uint32_t point);

}  // namespace marey::recordings
