// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

// Private to capture/.
namespace marey::capture {

/// libjpeg's decoder of brightness alone. OpenCV's would fill up what is missing of a
/// picture that was cut short, and print about it.
class JpegDecoder {
 public:
  JpegDecoder();
  JpegDecoder(JpegDecoder&&) noexcept;
  JpegDecoder& operator=(JpegDecoder&&) noexcept;
  ~JpegDecoder();

  /// Writes width_px * height_px pixels, rows from the top, into `gray`. nullopt when all
  /// went well, or what is wrong with the picture: "it is 640x480".
  [[nodiscard]] std::optional<std::string> decode(std::span<const std::byte> jpeg,
                                                  int width_px,
                                                  int height_px,
                                                  std::uint8_t* gray);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace marey::capture
