// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

// Private to capture.
namespace marey::capture {

/// Decodes only the brightness, with libjpeg, and reports damaged images. TurboJPEG
/// keeps only the text of the last warning, which does not distinguish missing parts of
/// an image from harmless bytes between its markers, which cameras write.
class JpegDecoder {
 public:
  JpegDecoder();
  JpegDecoder(JpegDecoder&&) noexcept;
  JpegDecoder& operator=(JpegDecoder&&) noexcept;
  ~JpegDecoder();

  /// Writes width_px * height_px pixels, rows from the top, into `gray`. Returns nullopt
  /// on success, otherwise the problem with the image: "it is 640x480".
  [[nodiscard]] std::optional<std::string> decode(std::span<const std::byte> jpeg,
                                                  int width_px,
                                                  int height_px,
                                                  std::uint8_t* gray);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace marey::capture
