// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/video/decode_jpeg.h"

#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstdlib>

// It needs <cstdio> before it.
#include <jerror.h>
#include <jpeglib.h>

#include "capture/video/read_image.h"

namespace marey::capture {

struct JpegDecoder::Impl {
  /// First member, so that libjpeg's pointer to it is also a pointer to this object.
  jpeg_error_mgr errors{};
  jpeg_decompress_struct jpeg{};
  std::jmp_buf on_error{};
  bool corrupt = false;
  std::array<char, JMSG_LENGTH_MAX> message{};

  Impl() {
    jpeg.err = jpeg_std_error(&errors);
    errors.error_exit = [](j_common_ptr j) {
      Impl& self = of(j);
      (*j->err->format_message)(j, self.message.data());
      // NOLINTNEXTLINE(modernize-avoid-setjmp-longjmp): libjpeg's only way out.
      std::longjmp(self.on_error, 1);
    };
    errors.emit_message = [](j_common_ptr j, int level) {
      if (level < 0) of(j).on_warning(j);
    };
    errors.output_message = [](j_common_ptr) {};
    // No memory, or another library version than the header's: not recoverable.
    // NOLINTNEXTLINE(modernize-avoid-setjmp-longjmp)
    if (setjmp(on_error) != 0) std::abort();
    jpeg_create_decompress(&jpeg);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() { jpeg_destroy_decompress(&jpeg); }

  static Impl& of(j_common_ptr j) { return *reinterpret_cast<Impl*>(j->err); }

  void on_warning(j_common_ptr j) {
    switch (j->err->msg_code) {
      case JWRN_EXTRANEOUS_DATA:
      case JWRN_ADOBE_XFORM:
      case JWRN_JFIF_MAJOR:
        return;  // No part of the image is missing.
      default:
        break;
    }
    if (!corrupt) (*j->err->format_message)(j, message.data());
    corrupt = true;
  }

  /// Target of setjmp(): no object with a destructor may be used here.
  bool read(std::span<const std::byte> bytes,
            JDIMENSION width_px,
            JDIMENSION height_px,
            std::uint8_t* gray) {
    if (setjmp(on_error) != 0) return false;
    jpeg_mem_src(&jpeg,
                 reinterpret_cast<const unsigned char*>(bytes.data()),
                 static_cast<unsigned long>(bytes.size()));
    jpeg_read_header(&jpeg, TRUE);
    if (jpeg.image_width != width_px || jpeg.image_height != height_px) return true;
    jpeg.out_color_space = JCS_GRAYSCALE;
    jpeg_start_decompress(&jpeg);
    while (jpeg.output_scanline < jpeg.output_height) {
      JSAMPROW row = gray + std::size_t{jpeg.output_scanline} * width_px;
      jpeg_read_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_decompress(&jpeg);
    return true;
  }
};

JpegDecoder::JpegDecoder() : impl_(std::make_unique<Impl>()) {}
JpegDecoder::JpegDecoder(JpegDecoder&&) noexcept = default;
JpegDecoder& JpegDecoder::operator=(JpegDecoder&&) noexcept = default;
JpegDecoder::~JpegDecoder() = default;

std::optional<std::string> JpegDecoder::decode(std::span<const std::byte> jpeg,
                                               int width_px,
                                               int height_px,
                                               std::uint8_t* gray) {
  Impl& impl = *impl_;
  impl.corrupt = false;
  if (jpeg.empty()) return "it is empty";
  const auto width = static_cast<JDIMENSION>(width_px);
  const auto height = static_cast<JDIMENSION>(height_px);
  const bool read = impl.read(jpeg, width, height, gray);
  const bool other_size =
      read && (impl.jpeg.image_width != width || impl.jpeg.image_height != height);
  const std::string size = size_text(static_cast<int>(impl.jpeg.image_width),
                                     static_cast<int>(impl.jpeg.image_height));
  jpeg_abort_decompress(&impl.jpeg);
  if (other_size) return "it is " + size + " and not " + size_text(width_px, height_px);
  if (!read || impl.corrupt)
    return "its JPEG is damaged: " + std::string(impl.message.data());
  return std::nullopt;
}

}  // namespace marey::capture
