// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/result.h"
#include "recordings/base/zip_archive.h"
#include "recordings/motion/npy_array.h"

// Private to recordings/: numpy's archives (.npz), without compression.
namespace marey::recordings {

/// Appends the bytes of a number. The format is little-endian, as are all supported
/// machines.
template <class T>
void append(std::string& bytes, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

/// Returns numpy's .npy, version 1.0: a Python dictionary in a header of whole 64 bytes,
/// and data. Precondition: the bytes match type ("<f8") and shape.
[[nodiscard]] std::string npy_bytes(std::string_view type,
                                    const NpyShape& shape,
                                    std::string_view data);

/// An archive under construction.
class NpzArrays {
 public:
  void add(std::string_view name,
           std::string_view type,
           const NpyShape& shape,
           std::string_view data);
  void add_number(std::string_view name, double value);
  void add_integer(std::string_view name, std::int64_t value);
  /// Adds texts in numpy's form: four bytes for each letter, padded with zeros.
  void add_texts(std::string_view name, const std::vector<std::string>& texts);
  /// Adds one text, an array without dimensions.
  void add_text(std::string_view name, const std::string& text);

  /// Returns the archive; nullopt if it is larger than 4 GiB.
  [[nodiscard]] std::optional<std::string> finish() { return std::move(zip_).finish(); }

 private:
  void add_texts_of_shape(std::string_view name,
                          const std::vector<std::string>& texts,
                          const NpyShape& shape);

  ZipWriter zip_;
};

/// Reads the arrays of an archive. Sizes are checked against the available bytes before
/// anything is allocated.
class NpzInput {
 public:
  /// `advice` is the next step of all errors.
  NpzInput(std::string file, std::string advice)
      : file_(std::move(file)), advice_(std::move(advice)) {}

  /// Errors (kBadInput): nullopt, or not an archive of arrays.
  [[nodiscard]] Status open(std::optional<ZipReader> zip);
  [[nodiscard]] bool has(std::string_view name) const;

  // Errors (kBadInput) of all: the array is missing, compressed, damaged, or of another
  // type or shape. `type` is numpy's word; "<U" means text of any length.
  [[nodiscard]] Result<NpyArray> array(std::string_view name,
                                       std::string_view type,
                                       const NpyShape& shape);
  template <class T>
  [[nodiscard]] Result<T> number(std::string_view name, std::string_view type) {
    const auto found = array(name, type, {});
    if (!found) return found.error();
    return found->at<T>(0);
  }
  /// An array of "<f8", whose bytes stay until drop(). Also an error: a number that is
  /// not finite, or above 1e12.
  [[nodiscard]] Result<NpyArray> real_array(std::string_view name, const NpyShape& shape);
  /// As real_array(), copied.
  [[nodiscard]] Result<std::vector<double>> reals(std::string_view name,
                                                  const NpyShape& shape);
  /// As reals(), of "<f4".
  [[nodiscard]] Result<std::vector<float>> floats(std::string_view name,
                                                  const NpyShape& shape);
  [[nodiscard]] Result<std::vector<std::string>> texts(std::string_view name,
                                                       std::size_t count);
  /// Returns the size of a list of any length.
  [[nodiscard]] Result<std::size_t> length(std::string_view name);
  /// Frees the bytes of an array: those of all frames are as large as the motion.
  void drop(std::string_view name);
  /// Returns the shape of an array.
  [[nodiscard]] Result<NpyShape> shape(std::string_view name);

  [[nodiscard]] Error fail(std::string cause) const;
  [[nodiscard]] Error fail(std::string_view array, std::string cause) const;

 private:
  /// Returns the bytes of an array's file, which stay valid; reads each file once.
  [[nodiscard]] Result<std::string_view> bytes_of(std::string_view name);

  std::string file_;
  std::string advice_;
  std::optional<ZipReader> zip_;
  std::map<std::string, std::string, std::less<>> files_;  ///< By name of the array.
};

}  // namespace marey::recordings
