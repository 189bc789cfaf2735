// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/base/sha256.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <memory>

extern "C" {
#include <libavutil/mem.h>
#include <libavutil/sha.h>
}

#include "core/base/assert.h"
#include "core/base/input_file.h"

namespace marey::recordings {
namespace {

/// SHA-256 of the bytes that are added.
class Sha256 {
 public:
  Sha256() : state_(av_sha_alloc(), av_free) {
    MAREY_ASSERT(state_ != nullptr);
    MAREY_ASSERT(av_sha_init(state_.get(), 256) == 0);
  }

  void add(std::string_view bytes) {
    av_sha_update(
        state_.get(), reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  }

  [[nodiscard]] std::string hex() {
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::array<std::uint8_t, 32> digest{};
    av_sha_final(state_.get(), digest.data());
    std::string text;
    for (const std::uint8_t byte : digest) {
      text += kDigits[byte >> 4U];
      text += kDigits[byte & 15U];
    }
    return text;
  }

 private:
  std::unique_ptr<AVSHA, decltype(&av_free)> state_;
};

}  // namespace

std::string sha256(std::string_view bytes) {
  Sha256 sum;
  sum.add(bytes);
  return sum.hex();
}

Result<std::string> sha256_of_file(const std::filesystem::path& path) {
  if (const Status ok = check_input_file(path); !ok) return ok.error();
  std::ifstream stream(path, std::ios::binary);
  constexpr std::size_t kPieceBytes = std::size_t{1} << 20;
  std::string piece(kPieceBytes, '\0');
  Sha256 sum;
  while (stream) {
    stream.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    sum.add(std::string_view(piece).substr(0, static_cast<std::size_t>(stream.gcount())));
  }
  // A complete read ends with eof(); a file that did not open has failed without it.
  if (!stream.eof() || stream.bad()) {
    return bad_input(
        path.string(), "it cannot be read", "check the name and permissions");
  }
  return sum.hex();
}

}  // namespace marey::recordings
